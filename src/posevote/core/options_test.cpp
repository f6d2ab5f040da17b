#include "posevote/core/options.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

struct Inner {
  double ratio = 0.8;
  void describe(OptionList& list) { list.add("ratio", ratio, {0, 1}, "", "Distance ratio."); }
};

struct Outer {
  int bins = 10;
  bool strict = false;
  std::string kind = "surf";
  Inner match;
  void describe(OptionList& list) {
    list.add("bins", bins, {2, 100}, "", "Bins per dimension.");
    list.add("strict", strict, "Refuse doubtful things.");
    list.add("kind", kind, {"surf", "sift"}, "Kind of features.");
    list.group("match", match);
  }
};

std::string error_of(const OptionList& list, const std::string& name, const std::string& text) {
  try {
    list.set(name, text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    return error.what();
  }
  return "";
}

TEST(OptionList, SetsEveryTypeByDottedName) {
  Outer options;
  const auto list = list_options(options);
  list.set("bins", "12");
  list.set("strict", "true");
  list.set("kind", "sift");
  list.set("match.ratio", "0.75");
  EXPECT_EQ(options.bins, 12);
  EXPECT_TRUE(options.strict);
  EXPECT_EQ(options.kind, "sift");
  EXPECT_DOUBLE_EQ(options.match.ratio, 0.75);
}

TEST(OptionList, TextOfAFieldIsReadBackUnchanged) {
  Outer options;
  const auto list = list_options(options);
  for (const auto& field : list.fields()) {
    const std::string before = field.text();
    list.set(field.name, before);
    EXPECT_EQ(field.text(), before);
  }
}

TEST(OptionList, UnknownNameNamesTheNearest) {
  Outer options;
  EXPECT_THAT(error_of(list_options(options), "match.ration", "1"),
              testing::HasSubstr("did you mean 'match.ratio'"));
}

TEST(OptionList, RefusesWrongValuesAndLeavesTheOldOne) {
  Outer options;
  const auto list = list_options(options);
  EXPECT_THAT(error_of(list, "bins", "1"), testing::HasSubstr("between 2 and 100"));
  EXPECT_THAT(error_of(list, "bins", "3x"), testing::HasSubstr("whole number"));
  EXPECT_THAT(error_of(list, "strict", "maybe"), testing::HasSubstr("true or false"));
  EXPECT_THAT(error_of(list, "kind", "orb"), testing::HasSubstr("one of surf, sift"));
  EXPECT_THAT(error_of(list, "match.ratio", "nan"), testing::HasSubstr("between 0 and 1"));
  EXPECT_EQ(options.bins, 10);
  EXPECT_EQ(options.kind, "surf");
}

TEST(OptionList, ValidateFindsAFieldSetBehindItsBack) {
  Outer options;
  options.match.ratio = std::nan("");
  EXPECT_THROW(validate_options(options), Error);
  options.match.ratio = 1.0;
  EXPECT_NO_THROW(validate_options(options));
}

TEST(NearestWord, IsEmptyWhenNothingIsNear) {
  EXPECT_EQ(nearest_word("zebra", {"bins", "match.ratio"}), "");
  EXPECT_EQ(nearest_word("", {}), "");
}

}  // namespace
}  // namespace posevote
