// The process is killed at any moment of teaching: what was finished stays, nothing else does.
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "posevote/store/sqlite/sqlite_store.hpp"
#include "program.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

class Kill : public Program {
 protected:
  /// Every view of the database, read completely (which checks all hashes).
  std::size_t check_views() const {
    if (!fs::exists(database())) return 0;
    const auto store = open_sqlite_store(database());
    std::size_t count = 0;
    for (const ObjectSummary& object : store->list())
      for (const ViewSummary& view : store->views(object.name)) {
        const TaughtView taught = store->view(object.name, view.id);
        EXPECT_EQ(content(taught.provenance.source),
                  std::string(taught.picture.begin(), taught.picture.end()));
        ++count;
      }
    return count;
  }

  std::uintmax_t bytes_on_disk() const {
    std::uintmax_t bytes = 0;
    for (const char* suffix : suffixes) {
      std::error_code ignored;
      const auto size = fs::file_size(database() + suffix, ignored);
      if (!ignored) bytes += size;
    }
    return bytes;
  }

  void remove_database() const {
    for (const char* suffix : suffixes) fs::remove(database() + suffix);
  }

  /// Teaches, and kills the process as soon as the files of the database hold that many bytes.
  void kill_when_grown(std::uintmax_t bytes) const {
    const pid_t child = start(lesson());
    ASSERT_GT(child, 0);
    bool ended = false;
    while (!ended && bytes_on_disk() < bytes) {
      std::this_thread::yield();
      ended = waitpid(child, nullptr, WNOHANG) != 0;
    }
    if (ended) return;
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }

  static constexpr const char* suffixes[] = {"", "-wal", "-journal", "-shm"};

  static std::vector<std::string> lesson() {
    std::vector<std::string> arguments{"teach", "muesli"};
    for (const auto& entry : fs::directory_iterator(demo("train/muesli")))
      if (entry.path().filename().string().starts_with("y"))
        arguments.push_back(entry.path().string());
    std::sort(arguments.begin() + 2, arguments.end());
    arguments.resize(2 + 4);  // views enough to be killed within, before, between and after
    arguments.insert(arguments.end(), {"--whole", "--brief"});
    return arguments;
  }
};

TEST_F(Kill, AtAnyMomentOfTeaching) {
  ASSERT_EQ(run(lesson()).status, 0);
  const std::size_t all = check_views();
  const std::uintmax_t full = bytes_on_disk();
  remove_database();

  constexpr int moments = 24;
  for (int i = 0; i < moments; ++i) {
    const std::size_t before = check_views();
    // From before the first byte until most is written; then on top of what is there.
    kill_when_grown(bytes_on_disk() + full * static_cast<std::uintmax_t>(i % 12) / 12 +
                    (i % 12 ? 1 : 0));
    const std::size_t after = check_views();
    EXPECT_GE(after, before) << "a finished view was lost";
    EXPECT_LE(after, all);
    if (i < 12) remove_database();
  }
  const Outcome again = run(lesson());
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(check_views(), all) << "run again, it finishes, and holds nothing twice";
}

TEST_F(Kill, ADatabaseThatWasLeftInTheMiddleCanBeUsed) {
  ASSERT_EQ(run({"teach", "poster", demo("train/poster/cover.jpg")}).status, 0);
  kill_when_grown(bytes_on_disk() + 400000);
  EXPECT_EQ(run({"recognize", demo("train/poster/cover.jpg")}).status, 0);
  const Outcome removal = run({"objects", "remove", "poster"});
  EXPECT_EQ(removal.status, 0) << removal.err;
}

}  // namespace
}  // namespace posevote
