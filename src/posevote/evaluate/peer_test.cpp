#include "posevote/evaluate/peer.hpp"

#include <gtest/gtest.h>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/made_dataset.hpp"

namespace posevote {
namespace {

TEST(Peer, FindsACoverAndProjectsItsOutline) {
  MadeDataset made(2);
  made.add_test("g", 1);
  const Dataset dataset = load_dataset(made.folder());
  const TaughtDataset taught = teach_dataset(dataset, {});
  for (const std::string& name : peer_names()) {
    const Peer peer(name, *taught.models);
    const auto outcomes = run_tests(
        dataset, [&](const cv::Mat& picture) { return peer.recognize(picture); }, 1);
    EXPECT_EQ(outcomes[0].score.right, 1) << name;
    EXPECT_EQ(outcomes[0].score.false_positives, 0) << name;
    EXPECT_GE(outcomes[0].result.detections[0].inliers, 10) << name;
  }
}

TEST(Peer, FindsNothingInAnEmptyPicture) {
  MadeDataset made(1);
  const TaughtDataset taught = teach_dataset(load_dataset(made.folder()), {});
  const Peer peer("opencv-sift", *taught.models);
  EXPECT_TRUE(peer.recognize(cv::Mat(50, 50, CV_8UC3, cv::Scalar::all(9))).detections.empty());
}

TEST(Peer, OfAnUnknownNameIsAnError) {
  EXPECT_THROW(Peer("opencv-surf", ModelSet()), Error);
}

TEST(ComparePeers, HasARowForEach) {
  MadeDataset made(1);
  made.add_test("g", 0);
  const Dataset dataset = load_dataset(made.folder());
  const Method method = make_method("default", {});
  const TaughtMethod taught(dataset, method);
  const ReportSection section =
      compare_peers(peer_names(), taught.evaluate(dataset), taught.taught(), method);
  ASSERT_EQ(section.tables[0].rows.size(), 3U);
  EXPECT_EQ(section.tables[0].rows[1][0], "opencv-sift");
  EXPECT_EQ(section.tables[0].rows[1][2], "1");
}

}  // namespace
}  // namespace posevote
