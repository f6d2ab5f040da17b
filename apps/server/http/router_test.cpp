#include "http/router.hpp"

#include <gmock/gmock.h>

#include "http/problem.hpp"

namespace posevote::server {
namespace {

class RouterTest : public testing::Test {
 protected:
  RouterTest() {
    for (const auto& [method, path] : std::vector<std::pair<std::string, std::string>>{
             {"GET", "/api/objects"},
             {"GET", "/api/objects/{object}"},
             {"DELETE", "/api/objects/{object}"},
             {"GET", "/api/objects/{object}/v/{view}"}})
      router_.add({method, path, Entry::open, nullptr});
  }

  const Route& find(const std::string& method, const std::string& path) {
    request_ = Request();
    request_.method = method;
    request_.path = path;
    return router_.find(request_);
  }

  int status(const std::string& method, const std::string& path) {
    try {
      static_cast<void>(find(method, path));
      return 200;
    } catch (const Problem& problem) {
      return problem.status();
    }
  }

  Router router_;
  Request request_;
};

TEST_F(RouterTest, ParametersAreDecodedAfterThePathIsSplit) {
  EXPECT_EQ(find("GET", "/api/objects/a%2Fb%20c%25/v/3").path, "/api/objects/{object}/v/{view}");
  EXPECT_EQ(request_["object"], "a/b c%");
  EXPECT_EQ(request_["view"], "3");
}

TEST_F(RouterTest, OtherPathsAndMethods) {
  EXPECT_EQ(status("GET", "/api/objects"), 200);
  EXPECT_EQ(status("GET", "/api/objects/"), 404);
  EXPECT_EQ(status("GET", "/api/objects//v/1"), 404);
  EXPECT_EQ(status("GET", "/api"), 404);
  EXPECT_EQ(status("GET", ""), 404);
  EXPECT_EQ(status("POST", "/api/objects"), 405);
  EXPECT_EQ(status("GET", "/api/objects/x/v/1/2"), 404);
}

TEST_F(RouterTest, WhatIsNoPercentEncodingIsRefused) {
  for (const char* bad : {"%", "%2", "%zz", "a%", "%00"})
    EXPECT_THROW(decode_segment(bad), Problem);
  EXPECT_EQ(decode_segment(""), "");
  EXPECT_EQ(decode_segment("%41+%c3%bc"), "A+\xc3\xbc");
}

}  // namespace
}  // namespace posevote::server
