#include "posevote/evaluate/requirement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Summary summary(int asked, int right, int false_positives) {
  Summary s;
  s.name = "set";
  s.images = 10;
  s.asked = asked;
  s.right = right;
  s.false_positives = false_positives;
  return s;
}

std::vector<std::string> unmet(const std::string& text, const Summary& s) {
  return unmet_requirements(parse_requirements(text), s);
}

TEST(Requirements, HoldAtTheBound) {
  EXPECT_THAT(unmet("recall=0.9,false_positives=1", summary(10, 9, 1)), IsEmpty());
  EXPECT_THAT(unmet("", summary(10, 0, 100)), IsEmpty());
}

TEST(Requirements, SayWhatIsNotMet) {
  EXPECT_THAT(unmet("recall=0.95,false_positives=0", summary(10, 9, 1)),
              ElementsAre(HasSubstr("recall is 0.9000, required is at least 0.9500"),
                          HasSubstr("false_positives is 1.0000, required is at most 0.0000")));
}

TEST(Requirements, AreNotMetByANumberThatDoesNotExist) {
  EXPECT_EQ(unmet("recall=0", summary(0, 0, 0)).size(), 1U);
}

TEST(Requirements, RefuseWhatCannotBeRead) {
  EXPECT_THROW(static_cast<void>(parse_requirements("recall")), Error);
  EXPECT_THROW(static_cast<void>(parse_requirements("recall=high")), Error);
  try {
    static_cast<void>(parse_requirements("recal=1"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'recall'"));
  }
}

}  // namespace
}  // namespace posevote
