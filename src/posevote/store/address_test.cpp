#include "posevote/store/address.hpp"

#include <gmock/gmock.h>

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
      {"cannot open 'postgresql://a:secret@h/d' and postgresql://b:secret@h",
       "cannot open 'postgresql://a:***@h/d' and postgresql://b:***@h"}};
  for (const auto& [given, expected] : cases) EXPECT_EQ(without_passwords(given), expected);
}

TEST(Address, EverythingElseStays) {
  for (const char* text :
       {"", "objects.db", "postgresql://robot@host:5432/db", "postgresql://host:5432/db?user=a@b",
        "postgresql://", "postgresql://h", "a:b@c", "postgresql://h:1/d x:y@z"})
    EXPECT_EQ(without_passwords(text), text);
}

}  // namespace
}  // namespace posevote
