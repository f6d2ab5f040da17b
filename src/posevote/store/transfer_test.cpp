#include "posevote/store/transfer.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "posevote/store/made_views.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;
using testing::StartsWith;

const FeatureRecord surf{"surf64 1", "kind=surf\n"};
const FeatureRecord sift{"sift128 1", "kind=sift\n"};

class Transfer : public testing::Test {
 protected:
  Transfer() {
    from_->add_view("mug", made_view(1), surf);
    from_->add_view("mug", made_view(2), surf);
    from_->add_view("cup", made_view(3), surf);
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(exports_.path), fs::directory_iterator()));
  }

  ScratchFolder folder_, exports_;
  std::string file_ = exports_.file("export.posevote");
  std::unique_ptr<ObjectStore> from_ = open_sqlite_store(folder_.file("from.db"));
  std::unique_ptr<ObjectStore> to_ = open_sqlite_store(folder_.file("to.db"));
};

TEST_F(Transfer, ExportAndImportGiveTheSameObjects) {
  EXPECT_EQ(export_objects(*from_, file_, {}).views_added, 3);
  EXPECT_EQ(files(), 1U);
  const auto result = import_objects(file_, *to_, {}, OnConflict::refuse);
  EXPECT_EQ(result.objects, 2);
  EXPECT_EQ(result.views_added, 3);
  EXPECT_EQ(to_->views("mug")[1].hash, from_->views("mug")[1].hash);
  EXPECT_EQ(to_->view("mug", "2").provenance.taught_at,
            from_->view("mug", "2").provenance.taught_at);
  EXPECT_EQ(to_->view("mug", "2").picture, from_->view("mug", "2").picture);
  EXPECT_EQ(files(), 1U);
}

TEST_F(Transfer, SomeObjectsCanBeChosen) {
  export_objects(*from_, file_, {"cup", "cup"});
  import_objects(file_, *to_, {}, OnConflict::refuse);
  EXPECT_EQ(to_->list().size(), 1U);
  EXPECT_THAT(error_of([&] { import_objects(file_, *to_, {"mug"}, OnConflict::refuse); }),
              StartsWith("not_found"));
}

TEST_F(Transfer, AnExistingFileIsNotOverwrittenSilently) {
  std::ofstream(file_) << "precious";
  EXPECT_THAT(error_of([&] { export_objects(*from_, file_, {}); }), StartsWith("already_exists"));
  EXPECT_EQ(fs::file_size(file_), 8U);
  export_objects(*from_, file_, {}, true);
  EXPECT_EQ(open_sqlite_store(file_)->list().size(), 2U);
}

TEST_F(Transfer, AFailedExportLeavesNoFile) {
  EXPECT_THAT(error_of([&] {
                export_objects(*from_, file_, {"mug", "pot"});
              }),
              StartsWith("not_found"));
  EXPECT_THAT(error_of([&] { export_objects(*to_, file_, {}); }), StartsWith("not_found"));
  EXPECT_EQ(files(), 0U);
}

TEST_F(Transfer, ConflictsAreRefusedMergedOrReplaced) {
  to_->add_view("mug", made_view(2), surf);
  to_->add_view("mug", made_view(7), surf);
  export_objects(*from_, file_, {});
  EXPECT_THAT(error_of([&] { import_objects(file_, *to_, {}, OnConflict::refuse); }),
              StartsWith("already_exists"));
  EXPECT_EQ(to_->list().size(), 1U) << "all or nothing";
  const auto merged = import_objects(file_, *to_, {}, OnConflict::merge);
  EXPECT_EQ(merged.views_added, 2);
  EXPECT_EQ(merged.views_known, 1);
  EXPECT_EQ(to_->views("mug").size(), 3U);
  import_objects(file_, *to_, {}, OnConflict::replace);
  EXPECT_EQ(to_->views("mug").size(), 2U);
}

TEST_F(Transfer, ACopyHoldsImpostorsToo) {
  from_->add_impostor({"", made_features(9), {1, 2, 3}, {}}, surf);
  EXPECT_EQ(save_copy(*from_, file_).views_added, 3);
  const auto copy = open_sqlite_store(file_);
  EXPECT_EQ(copy->views("mug")[1].hash, from_->views("mug")[1].hash);
  ASSERT_EQ(copy->impostors().size(), 1U);
  EXPECT_EQ(copy->impostors()[0].identity, from_->impostors()[0].identity);
  EXPECT_THAT(error_of([&] { save_copy(*from_, file_); }), StartsWith("already_exists"));
}

TEST_F(Transfer, ACopyMayHoldImpostorsOnlyOrNothing) {
  EXPECT_EQ(save_copy(*to_, file_).objects, 0);
  EXPECT_TRUE(open_sqlite_store(file_)->list().empty());
  fs::remove(file_);
  to_->add_impostor({"", made_features(9), {1, 2, 3}, {}}, surf);
  save_copy(*to_, file_);
  EXPECT_EQ(open_sqlite_store(file_)->impostors().size(), 1U);
}

TEST_F(Transfer, OtherFeaturesAreRefused) {
  to_->add_view("pot", made_view(9), sift);
  export_objects(*from_, file_, {});
  EXPECT_THAT(error_of([&] { import_objects(file_, *to_, {}, OnConflict::merge); }),
              StartsWith("feature_mismatch"));
  EXPECT_EQ(to_->list().size(), 1U);
}

TEST_F(Transfer, ImportLeavesTheFileAsItIs) {
  export_objects(*from_, file_, {});
  const auto time = fs::last_write_time(file_);
  const auto size = fs::file_size(file_);
  import_objects(file_, *to_, {}, OnConflict::refuse);
  EXPECT_EQ(fs::last_write_time(file_), time);
  EXPECT_EQ(fs::file_size(file_), size);
}

TEST_F(Transfer, WhatIsNoExportIsRefused) {
  std::ofstream(file_) << "this is not a database, it is a text that is long enough to be read";
  EXPECT_THAT(error_of([&] { import_objects(file_, *to_, {}, OnConflict::refuse); }),
              StartsWith("database_unusable"));
  EXPECT_THAT(error_of([&] { import_objects(exports_.file("no"), *to_, {}, OnConflict::refuse); }),
              StartsWith("not_found"));
}

}  // namespace
}  // namespace posevote
