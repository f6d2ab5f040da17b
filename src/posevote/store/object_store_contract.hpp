// The contract that every backend keeps: include it once and say which backends there are, e.g.
//   INSTANTIATE_TEST_SUITE_P(Sqlite, Store, testing::Values(sqlite));
#pragma once

#include "posevote/store/object_store.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "posevote/store/made_views.hpp"

namespace posevote::contract {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const FeatureRecord surf{"surf64 1", "kind=surf\n"};
const FeatureRecord sift{"sift128 1", "kind=sift\n"};

/// Opens a connection to one and the same database of a scratch folder.
struct Backend {
  const char* name;
  std::unique_ptr<ObjectStore> (*open)(const ScratchFolder& folder);
};

class Store : public testing::TestWithParam<Backend> {
 protected:
  std::unique_ptr<ObjectStore> open() const { return GetParam().open(folder_); }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& object : store_->list()) names.push_back(object.name);
    return names;
  }

  void SetUp() override {
    if (!store_) GTEST_SKIP() << "this backend's server is not there; run ctest";
  }

  ScratchFolder folder_;
  std::unique_ptr<ObjectStore> store_ = GetParam().open(folder_);
};

/// What a snapshot holds of features.
inline Features halves_of(Features features) {
  features.descriptors.convertTo(features.descriptors, CV_16F);
  return features;
}

inline void expect_equal(const Features& a, const Features& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Keypoint &p = a.keypoints[i], &q = b.keypoints[i];
    EXPECT_TRUE(p.x == q.x && p.y == q.y && p.scale == q.scale && p.angle == q.angle &&
                p.response == q.response && p.laplacian == q.laplacian);
  }
  ASSERT_EQ(a.descriptors.type(), b.descriptors.type());
  ASSERT_EQ(a.descriptors.size(), b.descriptors.size());
  const std::size_t bytes = a.descriptors.total() * a.descriptors.elemSize();
  EXPECT_TRUE(bytes == 0 || std::memcmp(a.descriptors.data, b.descriptors.data, bytes) == 0);
}

TEST_P(Store, ItSaysHowLargeItIs) {
  const std::int64_t empty = store_->size_bytes();
  EXPECT_GT(empty, 0);
  for (int i = 0; i < 20; ++i) store_->add_view("mug", made_view(i, 300), surf);
  EXPECT_GT(store_->size_bytes(), empty);
}

TEST_P(Store, ANewDatabaseIsEmpty) {
  EXPECT_TRUE(store_->list().empty());
  EXPECT_FALSE(store_->features());
  EXPECT_TRUE(store_->load()->objects().empty());
  EXPECT_FALSE(store_->read_only());
}

TEST_P(Store, AViewComesBackAsItWasAdded) {
  const TaughtView taught = made_view(1);
  EXPECT_EQ(store_->add_view("mug", taught, surf).id, "1");
  const TaughtView read = open()->view("mug", "1");
  EXPECT_EQ(read.view.id, "1");
  EXPECT_EQ(read.view.yaw_deg, 30);
  EXPECT_EQ(read.view.image_size, taught.view.image_size);
  EXPECT_EQ(read.view.outline, taught.view.outline);
  EXPECT_EQ(read.view.centre, taught.view.centre);
  expect_equal(read.view.features, taught.view.features);
  EXPECT_EQ(cv::norm(cv::imdecode(read.picture, cv::IMREAD_COLOR), taught.view.picture), 0);
  EXPECT_EQ(cv::norm(cv::imdecode(read.mask, cv::IMREAD_GRAYSCALE), taught.view.mask), 0);
  EXPECT_EQ(read.method, "mask");
  EXPECT_EQ(read.provenance.source, "picture1.png");
  EXPECT_EQ(read.provenance.version, "1.2.3");
  EXPECT_EQ(read.provenance.taught_at.size(), std::string("2026-01-02T03:04:05Z").size());
}

TEST_P(Store, EncodedPicturesAreKeptAsGiven) {
  TaughtView taught = made_view(1);
  cv::imencode(".jpg", taught.view.picture, taught.picture);
  store_->add_view("mug", taught, surf);
  EXPECT_EQ(store_->view("mug", "1").picture, taught.picture);
}

TEST_P(Store, LargePicturesAreKept) {
  TaughtView taught = made_view(1);
  taught.picture.resize(24'000'000);
  for (std::size_t i = 0; i < taught.picture.size(); ++i)
    taught.picture[i] = static_cast<std::uint8_t>((i * i) >> 7);
  store_->add_view("mug", taught, surf);
  EXPECT_TRUE(open()->view("mug", "1").picture == taught.picture);
}

TEST_P(Store, AnUnknownYawStaysUnknown) {
  TaughtView taught = made_view(1);
  taught.view.yaw_deg = std::nan("");
  store_->add_view("mug", taught, surf);
  EXPECT_TRUE(std::isnan(store_->view("mug", "1").view.yaw_deg));
  EXPECT_TRUE(std::isnan(store_->views("mug")[0].yaw_deg));
}

TEST_P(Store, TheSameViewIsStoredOnce) {
  store_->add_view("mug", made_view(1), surf);
  const AddResult again = store_->add_view("mug", made_view(1), surf);
  EXPECT_FALSE(again.added);
  EXPECT_EQ(again.id, "1");
  EXPECT_TRUE(store_->add_view("cup", made_view(1), surf).added);
  EXPECT_EQ(store_->views("mug").size(), 1U);
}

TEST_P(Store, SummariesTellWhatThereIs) {
  store_->add_view("mug", made_view(1, 5), surf);
  store_->add_view("mug", made_view(2, 7), surf);
  store_->add_view("book", made_view(3, 3), surf);
  EXPECT_THAT(names(), ElementsAre("book", "mug"));
  const ObjectSummary mug = store_->list()[1];
  EXPECT_EQ(mug.views, 2);
  EXPECT_EQ(mug.features, 12);
  const auto views = store_->views("mug");
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[1].id, "2");
  EXPECT_EQ(views[1].features, 7);
  EXPECT_EQ(views[1].image_size, cv::Size(20, 16));
  EXPECT_DOUBLE_EQ(views[1].coverage, 80.0 / 320);
}

TEST_P(Store, NumbersOfRemovedViewsAreNotUsedAgain) {
  store_->add_view("mug", made_view(1), surf);
  store_->add_view("mug", made_view(2), surf);
  store_->remove_view("mug", "2");
  EXPECT_EQ(store_->add_view("mug", made_view(3), surf).id, "3");
}

TEST_P(Store, RemovingTheLastViewRemovesTheObject) {
  store_->add_view("mug", made_view(1), surf);
  store_->remove_view("mug", "1");
  EXPECT_TRUE(store_->list().empty());
  EXPECT_THAT(error_of([&] { static_cast<void>(store_->views("mug")); }), StartsWith("not_found"));
}

TEST_P(Store, WhatIsNotThereIsSaidAndNothingChanges) {
  store_->add_view("mug", made_view(1), surf);
  const auto version = store_->version();
  const std::vector<std::function<void()>> actions{
      [&] { store_->remove_object("cup"); },
      [&] { store_->remove_view("mug", "7"); },
      [&] { store_->remove_view("mug", "1 "); },
      [&] { store_->remove_view("cup", "1"); },
      [&] { store_->rename_object("cup", "pot"); },
      [&] { static_cast<void>(store_->view("mug", "")); },
      [&] { static_cast<void>(store_->load_object("cup")); },
      [&] { store_->remove_impostor("1"); },
      [&] { static_cast<void>(store_->impostor("1")); }};
  for (const auto& action : actions) {
    EXPECT_THAT(error_of(action), StartsWith("not_found"));
    EXPECT_THAT(error_of(action), HasSubstr(store_->location()));
  }
  EXPECT_EQ(store_->version(), version);
}

TEST_P(Store, RenamingKeepsTheViewsAndRefusesTakenNames) {
  store_->add_view("mug", made_view(1), surf);
  store_->add_view("cup", made_view(2), surf);
  EXPECT_THAT(error_of([&] { store_->rename_object("mug", "cup"); }), StartsWith("already_exists"));
  store_->rename_object("mug", "mug");
  store_->rename_object("mug", "der große Becher 🍵");
  EXPECT_THAT(names(), ElementsAre("cup", "der große Becher 🍵"));
  EXPECT_EQ(store_->views("der große Becher 🍵").size(), 1U);
}

TEST_P(Store, NamesAreCheckedAndTakenLiterally) {
  for (const std::string& wrong :
       {std::string(), std::string("a\nb"), std::string("\xff"), std::string(201, 'x')}) {
    EXPECT_THAT(error_of([&] { store_->add_view(wrong, made_view(1), surf); }),
                StartsWith("invalid_argument"));
    EXPECT_TRUE(store_->list().empty());
  }
  const std::string nasty = "x'); DROP TABLE object; --";
  store_->add_view(nasty, made_view(1), surf);
  EXPECT_THAT(names(), ElementsAre(nasty));
}

TEST_P(Store, FeaturesOfAnotherKindAreRefused) {
  store_->add_view("mug", made_view(1), surf);
  EXPECT_THAT(error_of([&] { store_->add_view("cup", made_view(2), sift); }),
              testing::AllOf(StartsWith("feature_mismatch"), HasSubstr("objects rebuild")));
  EXPECT_THAT(error_of([&] {
                store_->add_impostor({"", {}, {1}, {}}, sift);
              }),
              StartsWith("feature_mismatch"));
  EXPECT_THAT(names(), ElementsAre("mug"));
  EXPECT_EQ(store_->features()->signature, surf.signature);
  store_->remove_object("mug");
  store_->add_view("cup", made_view(2), sift);
  EXPECT_EQ(store_->features()->signature, sift.signature);
}

TEST_P(Store, IncompleteViewsAreRefused) {
  TaughtView no_picture = made_view(1), no_outline = made_view(1), odd = made_view(1);
  no_picture.view.picture.release();
  no_outline.view.outline.resize(2);
  odd.view.features.keypoints.pop_back();
  for (const TaughtView& wrong : {no_picture, no_outline, odd})
    EXPECT_THAT(error_of([&] { store_->add_view("mug", wrong, surf); }),
                StartsWith("invalid_argument"));
  EXPECT_TRUE(store_->list().empty());
}

TEST_P(Store, AViewWithoutFeaturesIsKept) {
  store_->add_view("mug", made_view(1, 0), surf);
  EXPECT_TRUE(store_->load()->views()[0].view->features.empty());
}

TEST_P(Store, LoadGivesEverything) {
  store_->add_view("mug", made_view(1), surf);
  store_->add_view("mug", made_view(2), surf);
  store_->add_view("book", made_view(3), surf);
  store_->add_impostor({"", made_features(9), {1, 2, 3}, {}}, surf);
  const auto models = store_->load();
  EXPECT_EQ(models->signature(), surf.signature);
  ASSERT_EQ(models->objects().size(), 2U);
  EXPECT_EQ(models->objects()[0].name, "book");
  ASSERT_EQ(models->views().size(), 3U);
  expect_equal(models->views()[2].view->features, halves_of(made_view(2).view.features));
  EXPECT_TRUE(models->views()[2].view->picture.empty());
  const Patch expected = make_patch(made_view(2).view.picture, made_view(2).view.mask);
  const Patch& patch = models->views()[2].view->patch;
  ASSERT_EQ(patch.pixels.size(), expected.pixels.size());
  EXPECT_EQ(cv::norm(patch.pixels, expected.pixels), 0);
  EXPECT_EQ(cv::norm(patch.mask, expected.mask), 0);
  EXPECT_EQ(patch.corner, expected.corner);
  ASSERT_EQ(models->impostors().size(), 1U);
  expect_equal(models->impostors()[0], made_features(9));
  EXPECT_EQ(store_->load_object("mug").views.size(), 2U);
}

TEST_P(Store, PicturesAreLoadedOnDemand) {
  TaughtView grey16 = made_view(1);
  cv::imencode(".png", cv::Mat(16, 20, CV_16U, cv::Scalar(512)), grey16.picture);
  store_->add_view("mug", grey16, surf);
  LoadOptions options;
  options.pictures = true;
  const auto view = store_->load(options)->views()[0].view;
  EXPECT_EQ(view->picture.type(), CV_8UC3);
  EXPECT_EQ(view->picture.at<cv::Vec3b>(3, 3), cv::Vec3b(2, 2, 2));
  EXPECT_EQ(cv::norm(view->mask, grey16.view.mask), 0);
}

TEST_P(Store, SnapshotsShareUnchangedViews) {
  store_->add_view("mug", made_view(1), surf);
  const auto before = store_->load();
  store_->add_view("mug", made_view(2), surf);
  store_->rename_object("mug", "cup");
  const auto after = store_->load();
  ASSERT_EQ(before->views().size(), 1U);
  ASSERT_EQ(after->views().size(), 2U);
  EXPECT_EQ(before->views()[0].view, after->views()[0].view);
}

TEST_P(Store, TheVersionGrowsWithEveryChangeOfAnyConnection) {
  const auto other = open();
  std::int64_t version = store_->version();
  const auto expect_growth = [&] {
    EXPECT_GT(store_->version(), version);
    version = store_->version();
    EXPECT_EQ(other->version(), version);
  };
  other->add_view("mug", made_view(1), surf);
  expect_growth();
  other->rename_object("mug", "cup");
  expect_growth();
  store_->add_impostor({"", made_features(9), {1, 2, 3}, {}}, surf);
  expect_growth();
  store_->rebuild(surf, [](const auto&, const auto&) { return made_features(4); });
  expect_growth();
  other->remove_impostor("1");
  expect_growth();
  other->remove_object("cup");
  expect_growth();
  EXPECT_TRUE(store_->list().empty());
  EXPECT_EQ(store_->version(), version);
}

TEST_P(Store, ChangesOfOthersCanBeWaitedFor) {
  const std::int64_t version = store_->version();
  EXPECT_FALSE(store_->wait_for_change(version, std::chrono::milliseconds(20)));
  std::thread other([&] { open()->add_view("mug", made_view(1), surf); });
  EXPECT_TRUE(store_->wait_for_change(version, std::chrono::minutes(1)));
  other.join();
  EXPECT_GT(store_->version(), version);
  EXPECT_TRUE(store_->wait_for_change(version, std::chrono::milliseconds(0)));
}

TEST_P(Store, IdentityIsWhatWasTaughtAndHashIsWhatWasMadeOfIt) {
  store_->add_view("mug", made_view(1), surf);
  store_->add_view("cup", made_view(1), surf);
  const ViewSummary before = store_->views("mug")[0];
  EXPECT_EQ(before.identity, store_->views("cup")[0].identity);
  EXPECT_EQ(before.hash, store_->views("cup")[0].hash);
  store_->rebuild(surf, [](const auto&, const auto&) { return made_features(4); });
  EXPECT_EQ(store_->views("mug")[0].identity, before.identity);
  EXPECT_NE(store_->views("mug")[0].hash, before.hash);
}

TEST_P(Store, RebuildMakesAllFeaturesAgain) {
  store_->add_view("mug", made_view(1), surf);
  store_->add_view("book", made_view(2), surf);
  store_->add_impostor({"", made_features(9), {1, 2, 3}, {}}, surf);
  const auto old_hash = store_->views("mug")[0].hash;
  std::vector<std::size_t> mask_sizes;
  store_->rebuild(sift, [&](const auto& picture, const auto& mask) {
    EXPECT_FALSE(picture.empty());
    mask_sizes.push_back(mask.size());
    return made_features(5, 4, 128);
  });
  EXPECT_EQ(mask_sizes.size(), 3U);
  EXPECT_EQ(mask_sizes.back(), 0U);
  const auto models = open()->load();
  EXPECT_EQ(models->signature(), sift.signature);
  expect_equal(models->views()[1].view->features, halves_of(made_features(5, 4, 128)));
  expect_equal(models->impostors()[0], made_features(5, 4, 128));
  EXPECT_EQ(store_->features()->settings, sift.settings);
  EXPECT_NE(store_->views("mug")[0].hash, old_hash);
}

TEST_P(Store, AFailedRebuildChangesNothing) {
  store_->add_view("mug", made_view(1), surf);
  store_->add_view("book", made_view(2), surf);
  int calls = 0;
  EXPECT_THROW(store_->rebuild(sift,
                               [&](const auto&, const auto&) -> Features {
                                 if (++calls == 2) throw std::runtime_error("enough");
                                 return made_features(5, 4, 128);
                               }),
               std::runtime_error);
  EXPECT_EQ(store_->features()->signature, surf.signature);
  expect_equal(store_->view("mug", "1").view.features, made_view(1).view.features);
}

TEST_P(Store, ATransactionIsAllOrNothing) {
  const auto other = open();
  EXPECT_THROW(store_->transact([&] {
    store_->add_view("mug", made_view(1), surf);
    store_->add_view("cup", made_view(2), surf);
    EXPECT_EQ(store_->list().size(), 2U);
    EXPECT_TRUE(other->list().empty());
    throw std::runtime_error("enough");
  }),
               std::runtime_error);
  EXPECT_TRUE(store_->list().empty());
  store_->add_view("mug", made_view(1), surf);
  EXPECT_EQ(other->list().size(), 1U);
}

TEST_P(Store, ImpostorsCanBeListedSeenAndRemoved) {
  const Impostor impostor{"", made_features(9), {1, 2, 3}, {"camera:0", "", "1.2.3"}};
  const std::string id = store_->add_impostor(impostor, surf).id;
  EXPECT_FALSE(store_->add_impostor(impostor, surf).added);
  ASSERT_EQ(store_->impostors().size(), 1U);
  EXPECT_EQ(store_->impostors()[0].features, 5);
  EXPECT_EQ(store_->impostors()[0].identity.size(), 64U);
  EXPECT_EQ(store_->impostors()[0].provenance.source, "camera:0");
  EXPECT_EQ(store_->impostor(id).picture, impostor.picture);
  store_->remove_impostor(id);
  EXPECT_TRUE(store_->impostors().empty());
}

TEST_P(Store, DerivedBytesAreKeptAndAreNoChange) {
  store_->add_view("mug", made_view(1), surf);
  const std::int64_t version = store_->version();
  EXPECT_EQ(store_->derived("index").bytes, "");
  const std::string bytes("\0\xff\n\0", 4);
  store_->set_derived("index", {7, "old"});
  store_->set_derived("index", {version, bytes});
  EXPECT_EQ(open()->derived("index").bytes, bytes);
  EXPECT_EQ(open()->derived("index").version, version);
  EXPECT_EQ(store_->derived("other").bytes, "");
  EXPECT_EQ(store_->version(), version);
  store_->set_derived("index", {version, ""});
  EXPECT_EQ(store_->derived("index").bytes, "");
}

TEST_P(Store, NotesAreKeptUnderTheirKeys) {
  EXPECT_EQ(store_->note("a"), "");
  store_->set_note("a", "1\nñ");
  store_->set_note("b", "2");
  store_->set_note("a", "3\tñ");
  EXPECT_EQ(open()->note("a"), "3\tñ");
  EXPECT_EQ(store_->note("b"), "2");
  EXPECT_TRUE(store_->list().empty());
  EXPECT_FALSE(store_->features());
}

TEST_P(Store, ManyTeachersAndReadersAtOnce) {
  constexpr int teachers = 3, views_each = 8;
  std::atomic<int> running = teachers;
  std::vector<std::thread> threads;
  threads.reserve(teachers);
  for (int t = 0; t < teachers; ++t)
    threads.emplace_back([&, t] {
      const auto store = t == 0 ? nullptr : open();  // the first one shares a connection
      for (int i = 0; i < views_each; ++i)
        (store ? *store : *store_).add_view("mug", made_view(100 * t + i), surf);
      --running;
    });
  std::size_t seen = 0;
  while (running > 0) {
    const std::size_t now = store_->load()->views().size();
    EXPECT_GE(now, seen);
    seen = now;
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(store_->views("mug").size(), static_cast<std::size_t>(teachers * views_each));
  EXPECT_EQ(store_->views("mug").back().id, std::to_string(teachers * views_each));
}

}  // namespace posevote::contract
