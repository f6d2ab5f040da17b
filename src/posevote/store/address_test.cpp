#include "posevote/store/address.hpp"

#include <gmock/gmock.h>

#include "posevote/core/arguments.hpp"

namespace posevote {
namespace {

TEST(Address, PasswordsAreHidden) {
  const std::pair<const char*, const char*> cases[]{
      {"postgresql://robot:secret@host:5432/db", "postgresql://robot:***@host:5432/db"},
      {"postgres://robot:se:cr@et/@host/db", "postgres://robot:***@host/db"},
      {"postgresql://robot:secret@/db?host=/tmp", "postgresql://robot:***@/db?host=/tmp"},
      {"postgresql://robot@host/db?password=secret&x=1",
       "postgresql://robot@host/db?password=***&x=1"},
      {"postgresql://host/db?sslpassword=secret", "postgresql://host/db?sslpassword=***"},
      {"postgresql://robot:a?b@host/db", "postgresql://robot:***@host/db"},
      {"postgresql://robot:it's@host/db?x=1", "postgresql://robot:***@host/db?x=1"},
      {"postgresql://robot:say \"a b\"@host", "postgresql://robot:***@host"},
      {"postgresql://robot:100%sure@host", "postgresql://robot:***@host"},
      {"postgresql://robot:se/cret@host/db", "postgresql://robot:***@host/db"},
      {"postgresql://h/d?x=1&password=it's a b?c", "postgresql://h/d?x=1&password=***"},
      {"postgresql://h/d?pass%77ord=secret", "postgresql://h/d?pass%77ord=***"},
      {"--db=postgresql://robot:a b@h/d", "--db=postgresql://robot:***@h/d"},
      {"database:='postgresql://robot:a'b@h/d' is wrong",
       "database:='postgresql://robot:***@h/d' is wrong"},
      {"there is no 'postgresql://h/d?password=it's' here; see --help",
       "there is no 'postgresql://h/d?password=***' here; see --help"},
      {"cannot open 'postgresql://a:secret@h/d' and postgresql://b:secret@h",
       "cannot open 'postgresql://a:***@h/d' and postgresql://b:***@h"}};
  for (const auto& [given, expected] : cases) EXPECT_EQ(without_passwords(given), expected);
}

TEST(Address, APasswordIsHiddenHoweverItIsQuoted) {
  const std::tuple<const char*, const char*, const char*> cases[]{
      {"100%sure", "invalid percent-encoded token: \"100%sure\"",
       "invalid percent-encoded token: \"***\""},
      {"a%3Fb", "it is a?b, or a%3Fb", "it is ***, or ***"},
      {"p@ss", "could not translate host name \"ss@host\"",
       "could not translate host name \"***@host\""},
      {"se/cret", "invalid port \"se\"", "invalid port \"***\""},
      {"a", "a server that is gone: \"a\"", "*** server that is gone: \"***\""},
      {"***", "the password ***", "the password ***"},
      {"", "nothing to hide", "nothing to hide"}};
  for (const auto& [password, text, expected] : cases)
    EXPECT_EQ(without_passwords(text, "postgresql://robot:" + std::string(password) + "@host/db"),
              expected);
  EXPECT_EQ(without_passwords("is 'se cret'", "postgresql://h/d?password=se%20cret"), "is '***'");
}

TEST(Address, WhatIsHiddenOnceStaysAsItIs) {
  for (const char* text : {"database 'postgresql://h/d?password=***' cannot be reached: try again",
                           "database 'postgresql://a:***@h/d' cannot be reached"})
    EXPECT_EQ(without_passwords(text), text);
}

TEST(Address, ArgumentsAreTakenAndOverwritten) {
  std::vector<std::string> given{"program", "--db", "postgresql://robot:it's a?b@host/db", "x",
                                 "postgresql://a:b@c"};
  const std::vector<std::string> expected = given;
  std::vector<char*> argv = argv_of(given);
  EXPECT_EQ(take_arguments(5, argv.data()), expected);
  EXPECT_STREQ(argv[2], "postgresql://robot:***@host/db");
  EXPECT_STREQ(argv[3], "x");
  EXPECT_STREQ(argv[4], "postgresql://a:***");  // no more room
}

TEST(Address, EverythingElseStays) {
  for (const char* text :
       {"", "objects.db", "postgresql://robot@host:5432/db", "postgresql://host:5432/db?user=a@b",
        "postgresql://", "postgresql://h", "a:b@c", "postgresql://h:1/d x:y@z",
        "postgresql://robot@host:1/d?application_name=a@b"})
    EXPECT_EQ(without_passwords(text), text);
}

}  // namespace
}  // namespace posevote
