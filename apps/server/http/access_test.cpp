#include "http/access.hpp"

#include <gmock/gmock.h>

#include "http/problem.hpp"

namespace posevote::server {
namespace {

Request made_request(const std::string& method, const std::map<std::string, std::string>& headers) {
  Request request;
  request.method = method;
  request.header = [headers](const char* name) {
    const auto at = headers.find(name);
    return at == headers.end() ? "" : at->second;
  };
  return request;
}

bool allows(const AccessControl& access, const Request& request) {
  try {
    access.check_origin(request);
    return true;
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.status(), 403);
    return false;
  }
}

TEST(Access, EqualOnlyWhenEqual) {
  EXPECT_TRUE(equal_in_constant_time("", ""));
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  for (const char* other : {"", "ab", "abcd", "abd", "ABC"})
    EXPECT_FALSE(equal_in_constant_time("abc", other));
}

TEST(Access, Loopback) {
  for (const char* host : {"localhost", "LOCALHOST", "127.0.0.1", "127.1.2.3", "::1"})
    EXPECT_TRUE(is_loopback(host)) << host;
  for (const char* host : {"", "0.0.0.0", "128.0.0.1", "127.0.0.1.evil.org", "localhost.evil.org"})
    EXPECT_FALSE(is_loopback(host)) << host;
}

TEST(Access, HostsAndOrigins) {
  const AccessControl access({"", false, {"Robot"}});
  EXPECT_TRUE(allows(access, made_request("GET", {{"Host", "robot:80"}})));
  EXPECT_FALSE(allows(access, made_request("GET", {{"Host", "other"}})));
  EXPECT_FALSE(allows(access, made_request("GET", {})));
  const auto post = [&](const std::string& origin) {
    return allows(access, made_request("POST", {{"Host", "robot:80"}, {"Origin", origin}}));
  };
  EXPECT_TRUE(post("http://robot:80"));
  EXPECT_TRUE(post("https://ROBOT:80"));
  for (const char* origin : {"http://robot", "http://robot:81", "null", "robot:80", "http://evil"})
    EXPECT_FALSE(post(origin)) << origin;
}

TEST(Access, CookiesOfTheTokenOnly) {
  AccessControl access({"the token", true, {}}), other({"another token", true, {}});
  const std::string line = access.login("the token");
  const std::string pair = line.substr(0, line.find(';'));
  EXPECT_TRUE(access.authenticated(made_request("GET", {{"Cookie", pair}})));
  EXPECT_TRUE(access.authenticated(made_request("GET", {{"Cookie", "x=1; " + pair + "; y=2"}})));
  EXPECT_FALSE(other.authenticated(made_request("GET", {{"Cookie", pair}})));
  EXPECT_FALSE(access.authenticated(made_request("GET", {{"Cookie", "x" + pair}})));
  EXPECT_FALSE(access.authenticated(made_request("GET", {})));
}

TEST(Access, OverHttpsOnlyItsOwnPagesAndSecureCookies) {
  AccessControl open({"", true, {}}), encrypted({"", true, {}, true});
  const auto post = [](const AccessControl& access, const std::string& origin) {
    return allows(access, made_request("POST", {{"Host", "robot"}, {"Origin", origin}}));
  };
  EXPECT_TRUE(post(encrypted, "https://robot"));
  EXPECT_FALSE(post(encrypted, "http://robot"));
  EXPECT_TRUE(post(open, "http://robot"));
  EXPECT_TRUE(post(open, "https://robot")) << "a proxy may encrypt";
  for (const std::string& line : {encrypted.login(""), encrypted.logout()})
    EXPECT_THAT(line, testing::EndsWith("; Secure"));
  for (const std::string& line : {open.login(""), open.logout()})
    EXPECT_THAT(line, testing::Not(testing::HasSubstr("Secure")));
}

TEST(Access, GuessingIsSlowedDown) {
  AccessControl access({"the token", true, {}});
  for (int i = 0; i < 10; ++i) EXPECT_THROW(static_cast<void>(access.login("x")), Problem);
  try {
    static_cast<void>(access.login("the token"));
    FAIL();
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.status(), 429);
  }
}

TEST(Access, RandomDigits) {
  EXPECT_EQ(random_hex(16).size(), 32U);
  EXPECT_NE(random_hex(16), random_hex(16));
}

}  // namespace
}  // namespace posevote::server
