// What can be wrong with a database file.
#include "posevote/store/sqlite/connection.hpp"

#include <SQLiteCpp/Column.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <fstream>
#include <iterator>

#include "posevote/store/blob.hpp"
#include "posevote/store/made_views.hpp"
#include "posevote/store/sqlite/schema.hpp"

namespace posevote::sqlite {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const FeatureRecord surf{"surf64 1", "kind=surf\n"};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Connection : public testing::Test {
 protected:
  Connection() {
    const auto store = open_sqlite_store(path_);
    for (int i = 0; i < 20; ++i) store->add_view("mug", made_view(i, 40), surf);
  }

  void overwrite(std::size_t at, const std::string& text) const {
    std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(at));
    file << text;
  }

  /// Opens the database and reads everything, expects an error that names it and an untouched file.
  std::string refusal(const SqliteOptions& options = {}) const {
    const std::string before = content(path_);
    std::string error = error_of([&] {
      const auto store = open_sqlite_store(path_, options);
      static_cast<void>(store->load());
      for (const auto& view : store->views("mug")) static_cast<void>(store->view("mug", view.id));
    });
    EXPECT_THAT(error, HasSubstr(path_));
    EXPECT_EQ(content(path_), before);
    return error;
  }

  ScratchFolder folder_;
  std::string path_ = folder_.file("objects.db");
};

TEST_F(Connection, ClosingLeavesOneFile) {
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path), fs::directory_iterator()), 1);
}

TEST_F(Connection, WhatIsNoDatabaseIsRefused) {
  std::ofstream(path_) << std::string(5000, 'x');
  EXPECT_THAT(refusal(), AllOf(StartsWith("database_unusable"), HasSubstr("not a database")));
}

TEST_F(Connection, ADatabaseOfAnotherProgramIsRefused) {
  fs::remove(path_);
  SQLite::Database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("CREATE TABLE t (x)");
  EXPECT_THAT(refusal(), AllOf(StartsWith("database_unusable"), HasSubstr("not one of posevote")));
}

TEST_F(Connection, ANewerSchemaIsRefused) {
  SQLite::Database(path_, SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 9999");
  EXPECT_THAT(refusal(), AllOf(StartsWith("database_unusable"), HasSubstr("newer version")));
}

TEST_F(Connection, TruncatedFilesAreRefused) {
  const auto size = fs::file_size(path_);
  for (const auto rest : {size - 1, size - 4096, size / 2, std::uintmax_t{4096},
                          std::uintmax_t{1000}, std::uintmax_t{50}}) {
    fs::resize_file(path_, rest);
    EXPECT_THAT(refusal(), StartsWith("database_unusable")) << rest;
  }
}

TEST_F(Connection, OverwrittenPagesAreRefused) {
  const std::string original = content(path_);
  ASSERT_GT(original.size(), 20U * 4096);
  for (std::size_t page = 0; page < original.size() / 4096; page += 3) {
    std::ofstream(path_, std::ios::binary) << original;
    overwrite(page * 4096, std::string(200, 'x'));
    EXPECT_THAT(refusal(), StartsWith("database_unusable")) << page;
  }
}

TEST_F(Connection, AChangedNumberInAViewIsNoticed) {
  const Blob rows = encode_descriptors(made_view(7, 40).view.features);
  const std::string data = content(path_);
  const std::string begin(rows.begin(), rows.begin() + 16);
  const std::size_t at = data.find(begin);
  ASSERT_NE(at, std::string::npos);
  overwrite(at + 1, "?");
  EXPECT_THAT(refusal(), AllOf(StartsWith("database_unusable"), HasSubstr("rebuild")));
}

TEST_F(Connection, AFileThatIsNotThereIsMadeOnlyOnDemand) {
  const std::string other = folder_.file("other.db");
  for (const Access access : {Access::existing, Access::read_only}) {
    SqliteOptions options;
    options.access = access;
    EXPECT_THAT(error_of([&] { static_cast<void>(open_sqlite_store(other, options)); }),
                AllOf(StartsWith("not_found"), HasSubstr("posevote teach")));
    EXPECT_FALSE(fs::exists(other));
  }
  std::ofstream(other).close();
  EXPECT_TRUE(open_sqlite_store(other)->list().empty()) << "an empty file becomes a database";
}

TEST_F(Connection, PlacesThatCannotBeAreSaid) {
  EXPECT_THAT(error_of([&] { static_cast<void>(open_sqlite_store(folder_.path.string())); }),
              AllOf(StartsWith("io"), HasSubstr("folder")));
  EXPECT_THAT(error_of([&] { static_cast<void>(open_sqlite_store(folder_.file("no/x.db"))); }),
              AllOf(StartsWith("io"), HasSubstr("no folder")));
  EXPECT_THAT(error_of([&] { static_cast<void>(open_sqlite_store("/dev/zero")); }),
              StartsWith("io"));
}

TEST_F(Connection, ReadOnlyAccessReadsAndRefusesToWrite) {
  SqliteOptions options;
  options.access = Access::read_only;
  const auto store = open_sqlite_store(path_, options);
  EXPECT_TRUE(store->read_only());
  EXPECT_EQ(store->load()->views().size(), 20U);
  EXPECT_THAT(error_of([&] { store->remove_object("mug"); }),
              AllOf(StartsWith("io"), HasSubstr("read-only")));
}

TEST_F(Connection, AnUnwritableFolderStillReads) {
  const std::string odd = folder_.file("odd %41?#name.db");
  fs::rename(path_, odd);
  chmod(folder_.path.c_str(), 0555);
  const pid_t child = fork();
  if (child == 0) {
    // Root may write everywhere: become nobody.
    if (geteuid() == 0 && setuid(65534) != 0) _exit(9);
    try {
      SqliteOptions options;
      options.access = Access::existing;
      const auto store = open_sqlite_store(odd, options);
      const bool good = store->read_only() && store->load()->views().size() == 20;
      const std::string error = error_of([&] { store->remove_object("mug"); });
      _exit(good && error.find("read-only") != std::string::npos ? 0 : 1);
    } catch (...) {
      _exit(2);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  chmod(folder_.path.c_str(), 0755);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(Connection, AnotherWriterIsWaitedForOnlySoLong) {
  SqliteOptions options;
  options.busy_timeout_ms = 1;
  const auto store = open_sqlite_store(path_, options);
  SQLite::Database other(path_, SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  EXPECT_THAT(error_of([&] { store->remove_object("mug"); }),
              AllOf(StartsWith("io"), HasSubstr("in use")));
  EXPECT_EQ(store->load()->views().size(), 20U) << "reading goes on";
}

TEST_F(Connection, AFullDiskIsSaidAndHarmsNothing) {
  const auto store = open_sqlite_store(path_);
  {
    auto database = connect(path_, {});
    const int pages = database.execAndGet("PRAGMA page_count").getInt();
    EXPECT_THAT(error_of([&] {
                  guarded(path_, [&] {
                    database.exec("PRAGMA max_page_count = " + std::to_string(pages));
                    database.exec("INSERT INTO meta VALUES ('x', zeroblob(100000))");
                  });
                }),
                AllOf(StartsWith("io"), HasSubstr("disk is full")));
  }
  EXPECT_EQ(open_sqlite_store(path_)->load()->views().size(), 20U);
}

}  // namespace
}  // namespace posevote::sqlite
