#include "logic/tracks.hpp"

#include <gtest/gtest.h>

#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

Sighting at(double x, const std::string& object = "mug") {
  return {object, {x, 0, 100, 100}};
}

TEST(Tracker, KeepsTheNumberOfAnInstanceThatMovesALittle) {
  Tracker tracker;
  const auto first = tracker.update({at(0), at(300)});
  const auto second = tracker.update({at(310), at(10)});  // another order
  EXPECT_EQ(second[0].id, first[1].id);
  EXPECT_EQ(second[1].id, first[0].id);
}

TEST(Tracker, ConfirmsAfterSomeSightings) {
  TrackOptions options;
  options.confirm_after = 3;
  Tracker tracker(options);
  EXPECT_FALSE(tracker.update({at(0)})[0].confirmed);
  EXPECT_FALSE(tracker.update({at(0)})[0].confirmed);
  EXPECT_TRUE(tracker.update({at(0)})[0].confirmed);
}

TEST(Tracker, ForgetsAfterSomeMissesNotBefore) {
  TrackOptions options;
  options.forget_after = 2;
  Tracker tracker(options);
  const auto id = tracker.update({at(0)})[0].id;
  (void)tracker.update({});
  EXPECT_EQ(tracker.update({at(0)})[0].id, id);
  (void)tracker.update({});
  (void)tracker.update({});
  EXPECT_NE(tracker.update({at(0)})[0].id, id);
}

TEST(Tracker, FollowsTheOnlyInstanceHoweverFarItJumps) {
  Tracker tracker;
  const auto id = tracker.update({at(0)})[0].id;
  EXPECT_EQ(tracker.update({at(900)})[0].id, id);
}

TEST(Tracker, DoesNotGuessAmongSeveral) {
  Tracker tracker;
  const auto before = tracker.update({at(0), at(300)});
  const auto after = tracker.update({at(900)});
  EXPECT_NE(after[0].id, before[0].id);
  EXPECT_NE(after[0].id, before[1].id);
}

TEST(Tracker, NeverMixesObjects) {
  Tracker tracker;
  const auto mug = tracker.update({at(0, "mug")})[0];
  const auto book = tracker.update({at(0, "book")})[0];
  EXPECT_NE(mug.id, book.id);
  EXPECT_EQ(book.place, 1);
}

TEST(Tracker, GivesFreedPlacesAgainButNoNumbers) {
  TrackOptions options;
  options.forget_after = 1;
  Tracker tracker(options);
  const auto two = tracker.update({at(0), at(300)});
  EXPECT_EQ(two[0].place, 1);
  EXPECT_EQ(two[1].place, 2);
  (void)tracker.update({at(300)});  // the first is gone
  const auto again = tracker.update({at(300), at(700)});
  EXPECT_EQ(again[0].place, 2);
  EXPECT_EQ(again[1].place, 1);
  EXPECT_EQ(again[1].id, 3u);
}

TEST(Tracker, ThrowsOnOptionsOutOfRange) {
  TrackOptions options;
  options.confirm_after = 0;
  EXPECT_THROW(Tracker{options}, Error);
}

TEST(TrackFrame, IsPrefixNameAndPlace) {
  EXPECT_EQ(track_frame("posevote/", "blue mug", {7, 2, true}), "posevote/blue mug_2");
}

}  // namespace
}  // namespace posevote::logic
