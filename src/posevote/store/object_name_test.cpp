#include "posevote/store/object_name.hpp"

#include <gmock/gmock.h>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

TEST(ObjectName, TextOfAnyLanguageIsTaken) {
  for (const char* name : {"a", "mug 3", "der große Becher", "抹茶", "☕", "a/b\\c", "'; --", ".."})
    EXPECT_NO_THROW(check_object_name(name)) << name;
  EXPECT_NO_THROW(check_object_name(std::string(200, 'x')));
  EXPECT_NO_THROW(check_object_name("\xf4\x8f\xbf\xbf"));  // U+10FFFF
}

TEST(ObjectName, EverythingElseIsRefused) {
  for (const std::string& name :
       {std::string(), std::string(201, 'x'), std::string(" a"), std::string("a "),
        std::string("a\tb"), std::string("a\nb"), std::string("a\0b", 3), std::string("\x7f"),
        std::string("\xc2\x85"),          // U+0085, a control character
        std::string("\x80"),              // continuation without a beginning
        std::string("\xc3"),              // beginning without continuation
        std::string("\xc0\xaf"),          // overlong
        std::string("\xed\xa0\x80"),      // surrogate
        std::string("\xf4\x90\x80\x80"),  // above U+10FFFF
        std::string("\xff\xff\xff\xff")})
    EXPECT_THROW(check_object_name(name), Error) << testing::PrintToString(name);
}

}  // namespace
}  // namespace posevote
