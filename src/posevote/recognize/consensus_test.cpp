#include "posevote/recognize/consensus.hpp"

#include <gtest/gtest.h>

namespace posevote {
namespace {

std::shared_ptr<const View> square_view(const char* id) {
  View view;
  view.id = id;
  view.image_size = {100, 100};
  view.outline = {{0, 0}, {99, 0}, {99, 99}, {0, 99}};
  view.centre = {50, 50};
  return std::make_shared<const View>(view);
}

ModelSet two_objects() {
  return {"surf64 1",
          {{"box", {square_view("1"), square_view("2"), square_view("3")}},
           {"can", {square_view("1")}}}};
}

Hypothesis placed(int view, double x, int inliers) {
  Hypothesis hypothesis;
  hypothesis.view = view;
  hypothesis.scene_from_view = {1, 0, x, 0, 1, 0, 0, 0, 1};
  hypothesis.evidence.inliers.resize(static_cast<std::size_t>(inliers));
  hypothesis.stage = HypothesisStage::presence;
  return hypothesis;
}

TEST(Consensus, IsTheMeanOverlapWithOtherViewsByTheirInliers) {
  std::vector<Hypothesis> found{placed(0, 0, 10), placed(1, 0, 30), placed(2, 50, 10)};
  measure_consensus(found, two_objects());
  EXPECT_NEAR(found[0].measured.consensus, (30 * 1.0 + 10 / 3.0) / 40, 0.01);
  EXPECT_NEAR(found[2].measured.consensus, 1 / 3.0, 0.01);
}

TEST(Consensus, OtherPlacesObjectsAndTheViewItselfSayNothing) {
  std::vector<Hypothesis> found{placed(0, 0, 10), placed(0, 0, 10), placed(1, 90, 10),
                                placed(3, 0, 10)};
  measure_consensus(found, two_objects());
  EXPECT_LT(found[0].measured.consensus, 0);
  EXPECT_LT(found[3].measured.consensus, 0);
}

TEST(Consensus, RejectedHypothesesHaveNoSay) {
  std::vector<Hypothesis> found{placed(0, 0, 10), placed(1, 0, 10)};
  found[1].rejected = "so much agreement happens by chance";
  measure_consensus(found, two_objects());
  EXPECT_LT(found[0].measured.consensus, 0);
}

}  // namespace
}  // namespace posevote
