#include "studio/teach_session.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "http/problem.hpp"

namespace posevote::server {
namespace {

namespace fs = std::filesystem;

constexpr double kWait = 600;  // s

class TeachSessionTest : public testing::Test {
 protected:
  TeachSessionTest() { fs::create_directory(folder_); }
  ~TeachSessionTest() override { fs::remove_all(folder_); }

  /// Blots of noise: many features, so that a look takes its time.
  static SentPicture picture(int width) {
    cv::Mat coarse(width / 16, width / 12, CV_8UC3);
    cv::RNG(1).fill(coarse, cv::RNG::UNIFORM, 0, 256);
    SentPicture sent;
    cv::resize(coarse, sent.image, {width, width * 3 / 4}, 0, 0, cv::INTER_CUBIC);
    sent.encoded = encode_png(sent.image);
    sent.source = "test";
    return sent;
  }

  /// Looks at a large picture in a thread of its own; returns when that has begun.
  std::thread begin_look(std::atomic<bool>& ended) {
    double idle_s = session_.idle_s();
    std::thread looking([&] {
      Wish wish;
      wish.whole = true;
      try {
        session_.propose(picture(2000), wish, TeachOptions());
      } catch (const Problem& problem) {
        EXPECT_EQ(problem.status(), 404);
      }
      ended = true;
    });
    double before = 0;
    while (idle_s >= before && !ended) {
      before = idle_s;
      idle_s = session_.idle_s();
    }
    return looking;
  }

  std::string folder_ =
      (fs::temp_directory_path() / ("posevote-session-" + std::to_string(getpid()))).string();
  TeachSession session_{"id", folder_ + "/id.posevote", kWait};
};

TEST_F(TeachSessionTest, ItAnswersWhileItLooks) {
  std::atomic<bool> ended = false;
  std::thread looking = begin_look(ended);
  int answers = 0;
  for (; !ended; ++answers) EXPECT_EQ(session_.json()["session"], "id");
  looking.join();
  EXPECT_GT(answers, 100) << "a look takes longer than many answers";
  EXPECT_TRUE(session_.proposal().view.has_value());
}

TEST_F(TeachSessionTest, WhatIsDiscardedDuringALookKeepsNothing) {
  std::atomic<bool> ended = false;
  std::thread looking = begin_look(ended);
  session_.discard();
  EXPECT_FALSE(ended) << "nobody waits for the look";
  looking.join();
  EXPECT_THROW(static_cast<void>(session_.proposal()), Problem);
  EXPECT_THROW(session_.set_background(picture(160)), Problem);
}

TEST_F(TeachSessionTest, WithoutAProposalThereIsNothingToCorrectOrAccept) {
  EXPECT_THROW(session_.correct(cv::Mat(3, 4, CV_8U), TeachOptions()), Problem);
  EXPECT_THROW(session_.accept(std::nullopt, FeatureOptions(), "1"), Problem);
  EXPECT_THROW(session_.remove_view("1"), Problem);
}

TEST_F(TeachSessionTest, WhatTheObjectHasAlreadyAddsNothing) {
  Wish wish;
  wish.whole = true;
  wish.yaw_deg = 30;
  const Proposal first = session_.propose(picture(480), wish, TeachOptions());
  EXPECT_EQ(first.json()["adds_little"], false);
  EXPECT_EQ(session_.json()["object"], Json());
  TeachSession more("more", folder_ + "/more.posevote", kWait,
                    {"box", {std::make_shared<const View>(*first.view)}});
  const Json begun = more.json();
  EXPECT_EQ(begun["object"], "box");
  EXPECT_EQ(begun["known_yaws"], Json({30}));
  EXPECT_EQ(begun["next_yaw"], 60);
  EXPECT_EQ(begun["views"].size(), 0U);
  EXPECT_EQ(more.propose(picture(480), wish, TeachOptions()).json()["adds_little"], true);
}

TEST_F(TeachSessionTest, AllSidesRoundItIsEnough) {
  const SentPicture seen = picture(320);
  Wish wish;
  wish.whole = true;
  for (int yaw = 0; yaw < 360; yaw += 30) {
    EXPECT_EQ(session_.json()["enough"], false) << yaw;
    wish.yaw_deg = yaw;
    session_.propose(seen, wish, TeachOptions());
    session_.accept(std::nullopt, TeachOptions().feature, "1");
  }
  EXPECT_EQ(session_.json()["enough"], true);
  EXPECT_EQ(session_.json()["next_yaw"], Json());
  session_.remove_view("5");
  EXPECT_EQ(session_.json()["enough"], false);
  session_.restore_view("5");
  EXPECT_EQ(session_.json()["enough"], true);
  EXPECT_THROW(session_.restore_view("5"), Problem) << "it is back already";
}

TEST_F(TeachSessionTest, AViewThatAddsLittleIsMarkedUntilTheOneThatItRepeatsIsGone) {
  Wish wish;
  wish.whole = true;
  for (const int yaw : {0, 30}) {
    wish.yaw_deg = yaw;
    session_.propose(picture(480), wish, TeachOptions());
    session_.accept(std::nullopt, TeachOptions().feature, "1");
  }
  const auto marks = [](const TeachSession& session) {
    std::vector<bool> all;
    const Json json = session.json();
    for (const Json& view : json["views"]) all.push_back(view["adds_little"]);
    return all;
  };
  EXPECT_EQ(marks(session_), (std::vector<bool>{false, true}));
  EXPECT_EQ(marks(TeachSession("id", folder_ + "/id.posevote", kWait)), marks(session_))
      << "after a restart, too";
  session_.remove_view("1");
  EXPECT_EQ(marks(session_), std::vector<bool>{false});
  session_.restore_view("1");
  EXPECT_EQ(marks(session_), (std::vector<bool>{false, true}));
}

TEST_F(TeachSessionTest, ACorrectedMaskReplacesTheProposalAndKeepsItsSide) {
  Wish wish;
  wish.whole = true;
  wish.yaw_deg = 60;
  const SentPicture seen = picture(480);
  const Proposal whole = session_.propose(seen, wish, TeachOptions());
  cv::Mat mask = cv::Mat::zeros(seen.image.size(), CV_8U);
  mask(cv::Rect(80, 60, 240, 200)).setTo(255);
  const Proposal corrected = session_.correct(mask, TeachOptions());
  EXPECT_EQ(corrected.method, "mask");
  EXPECT_EQ(corrected.yaw_deg, 60);
  EXPECT_LT(corrected.view->features.size(), whole.view->features.size());
  session_.accept(std::nullopt, TeachOptions().feature, "1");
  EXPECT_EQ(session_.json()["views"].size(), 1U);
  EXPECT_EQ(TeachSession("id", folder_ + "/id.posevote", kWait).json()["views"][0]["yaw"], 60)
      << "it is on the disk";
}

}  // namespace
}  // namespace posevote::server
