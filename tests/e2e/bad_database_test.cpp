// Databases that cannot be used, or not be written, stay as they are.
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "posevote/store/sqlite/sqlite_store.hpp"
#include "program.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

class BadDatabase : public Program {
 protected:
  void SetUp() override { teach_poster(); }

  /// Every command refuses the database and leaves it as it is.
  void expect_refused(const std::string& reason) const {
    const std::string before = content(database());
    const std::vector<std::vector<std::string>> commands{
        {"teach", "x", view_},           {"recognize", scene_},  {"objects", "list"},
        {"objects", "remove", "poster"}, {"objects", "rebuild"}, {"bench"}};
    for (const auto& command : commands) {
      SCOPED_TRACE(testing::PrintToString(command));
      expect_failure(run(command), 1, {database(), reason});
      EXPECT_EQ(content(database()), before);
    }
  }

  void overwrite(std::size_t at, const std::string& text) const {
    std::fstream file(database(), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(at));
    file << text;
  }

  std::string view_ = demo("train/muesli/y000.jpg");
  std::string scene_ = small_scene();
};

TEST_F(BadDatabase, NotADatabase) {
  write("objects.db", std::string(10000, 'x'));
  expect_refused("not a database");
}

TEST_F(BadDatabase, Truncated) {
  fs::resize_file(database(), fs::file_size(database()) / 2);
  expect_refused("damaged");
}

TEST_F(BadDatabase, Overwritten) {
  overwrite(std::size_t{3} * 4096, std::string(8192, 'x'));
  expect_refused("damaged");
}

TEST_F(BadDatabase, OfANewerVersion) {
  overwrite(60, std::string("\0\0\x7f\0", 4));  // user_version of the file's header
  expect_refused("newer version");
}

TEST_F(BadDatabase, OfAnotherProgram) {
  overwrite(68, "SOME");  // application_id of the file's header
  expect_refused("not one of posevote");
}

TEST_F(BadDatabase, Missing) {
  fs::remove(database());
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"recognize", scene_}, {"objects", "list"}, {"bench"}}) {
    expect_failure(run(command), 1, {database(), "posevote teach"});
    EXPECT_FALSE(fs::exists(database()));
  }
  expect_failure(run({"teach", "x", path("missing.jpg")}), 1, {"missing.jpg"});
  EXPECT_FALSE(fs::exists(database())) << "nothing was taught, so nothing is made";
}

TEST_F(BadDatabase, AFolderOrAnUnknownServer) {
  expect_failure(run({"objects", "list", "--db", folder_}), 1, {folder_, "folder"});
  expect_failure(run({"teach", "x", view_, "--db", path("no/x.db")}), 1, {path("no")});
  expect_failure(run({"objects", "list", "--db", "postgresql://127.0.0.1:1/db"}), 1,
                 {"postgresql://127.0.0.1:1/db"});
}

void become_nobody() {
  if (geteuid() == 0 && setuid(65534) != 0) _exit(9);  // root may write everywhere
}

TEST_F(BadDatabase, ReadOnly) {
  const std::string before = content(database());
  const std::string view = path("view.jpg");  // the project may lie in a private folder
  fs::copy_file(view_, view);
  fs::permissions(database(), fs::perms(0444));
  fs::permissions(folder_, fs::perms(0555));
  const Outcome recognised = run({"recognize", scene_}, become_nobody);
  EXPECT_EQ(recognised.status, 0) << recognised.err;
  expect_failure(run({"teach", "x", view}, become_nobody), 1, {database(), "read-only"});
  expect_failure(run({"teach", "x", view, "--db", path("new.db")}, become_nobody), 1,
                 {path("new.db")});
  fs::permissions(folder_, fs::perms::all);
  EXPECT_EQ(content(database()), before);
}

TEST_F(BadDatabase, NoFileMayGrow) {
  const std::string before = content(database());
  for (const rlim_t kilobytes : {1, 8, 40, 100}) {
    const Outcome outcome = run({"teach", "x", view_}, [&] {
      const rlimit limit{kilobytes * 1024, kilobytes * 1024};
      setrlimit(RLIMIT_FSIZE, &limit);
    });
    expect_failure(outcome, 1, {database()});
    EXPECT_EQ(run({"objects", "list", "--names"}).out, "poster\n") << kilobytes;
  }
  EXPECT_EQ(content(database()), before);
}

TEST_F(BadDatabase, AFullDisk) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may mount a small file system";
  const std::string disk = path("disk");
  fs::create_directory(disk);
  if (mount("none", disk.c_str(), "tmpfs", 0, "size=2m") != 0)
    GTEST_SKIP() << "no file system may be mounted here";
  const std::string small = disk + "/objects.db";
  EXPECT_EQ(run({"teach", "poster", demo("train/poster/cover.jpg"), "--db", small}).status, 0);
  // Teaches until nothing more fits.
  std::size_t fitted = 0;
  Outcome outcome;
  for (const auto& entry : fs::directory_iterator(demo("train/muesli"))) {
    if (!entry.path().filename().string().starts_with("y")) continue;
    outcome = run({"teach", "muesli", entry.path().string(), "--whole", "--db", small});
    if (outcome.status != 0) break;
    ++fitted;
  }
  expect_failure(outcome, 1, {small, "full"});
  const auto store = open_sqlite_store(small, {.access = Access::read_only});
  std::size_t views = 0;
  for (const ObjectSummary& object : store->list())
    for (const ViewSummary& view : store->views(object.name)) {
      static_cast<void>(store->view(object.name, view.id));
      ++views;
    }
  EXPECT_EQ(views, 1 + fitted);
  umount2(disk.c_str(), MNT_DETACH);
}

}  // namespace
}  // namespace posevote
