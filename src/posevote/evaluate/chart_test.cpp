#include "posevote/evaluate/chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace posevote {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pointwise;

TEST(RoundTicks, AreRoundAndInside) {
  EXPECT_THAT(round_ticks(0, 1, 5),
              Pointwise(testing::DoubleNear(1e-12), {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_THAT(round_ticks(90, 270, 6), ElementsAre(100, 150, 200, 250));
  EXPECT_THAT(round_ticks(3, 3, 5), ElementsAre(3));
}

TEST(Chart, DrawsEveryFinitePointOnce) {
  const Chart chart{"t", {"x", 0, 0}, {"y", 0, 0}, {{"a", {{0, 1}, {1, std::nan("")}, {2, 3}}}}};
  const std::string svg = chart.to_svg();
  std::size_t circles = 0;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++circles;
  EXPECT_EQ(circles, 2U);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Chart, WithoutPointsIsStillAPicture) {
  const std::string svg = Chart{"empty", {"x", 0, 0}, {"y", 0, 0}, {{"a", {}}}}.to_svg();
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Chart, EscapesNames) {
  const Chart chart{"a<b", {"x", 0, 1}, {"y", 0, 1}, {{"<s>", {{0, 0}}}, {"u", {{1, 1}}}}};
  EXPECT_THAT(chart.to_svg(), HasSubstr("a&lt;b"));
  EXPECT_THAT(chart.to_svg(), Not(HasSubstr("<s>")));
}

TEST(IntervalSvg, LeavesOutWhatIsNotANumber) {
  const std::string svg = interval_svg("r", {{"one", 0.5, 0.4, 0.6}, {"none", std::nan(""), 0, 1}});
  EXPECT_THAT(svg, HasSubstr("50.0 %"));
  EXPECT_THAT(svg, HasSubstr("none"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace posevote
