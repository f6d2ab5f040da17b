#include "static_page.hpp"

#include <gmock/gmock.h>

#include "http/problem.hpp"

namespace posevote::server {
namespace {

Request made_request(const std::string& path, const std::string& tag = "") {
  Request request;
  request.method = "GET";
  request.path = path;
  request.header = [tag](const char* name) {
    return name == std::string("If-None-Match") ? tag : "";
  };
  return request;
}

const std::vector<EmbeddedFile> kFiles{{"index.html", "<p>", "1"}, {"a/app.js", "let x", "2"}};

TEST(StaticPage, FilesWithTheirTypes) {
  const Response index = page_response(made_request("/"), kFiles);
  EXPECT_EQ(index.body, "<p>");
  EXPECT_EQ(index.type, "text/html; charset=utf-8");
  EXPECT_EQ(page_response(made_request("/a/app.js"), kFiles).type,
            "text/javascript; charset=utf-8");
  for (const char* path : {"/a", "/app.js", "/../index.html", "/index.html/", ""})
    EXPECT_THROW(static_cast<void>(page_response(made_request(path), kFiles)), std::exception)
        << path;
}

TEST(StaticPage, WhatTheBrowserHasIsNotSentAgain) {
  EXPECT_EQ(page_response(made_request("/", "\"1\""), kFiles).status, 304);
  EXPECT_EQ(page_response(made_request("/", "\"2\""), kFiles).status, 200);
}

TEST(StaticPage, ABuildWithoutPageSaysSo) {
  const Response response = page_response(made_request("/"), {});
  EXPECT_THAT(response.body, testing::HasSubstr("holds no page"));
  EXPECT_THROW(static_cast<void>(page_response(made_request("/app.js"), {})), Problem);
}

TEST(StaticPage, TheDescriptionIsEmbeddedAsItIs) {
  const auto text = find_embedded(embedded_api(), "openapi.yaml");
  ASSERT_TRUE(text);
  EXPECT_THAT(*text, testing::StartsWith("openapi: 3"));
  EXPECT_THAT(*text, testing::EndsWith("\n"));
}

}  // namespace
}  // namespace posevote::server
