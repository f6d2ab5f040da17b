// One picture, one database: library, command, server and Python package say the same.
#include <cstdio>

#include "posevote/image/read_image.hpp"
#include "posevote/json/recognition_json.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"
#include "program.hpp"
#ifdef POSEVOTE_WITH_SERVER
#include "../server/server_process.hpp"
#endif

namespace posevote {
namespace {

class SameResult : public Program {
 protected:
  void SetUp() override {
    teach_poster();
    ASSERT_EQ(run({"teach", "muesli", demo("train/muesli/y000.jpg"), "--background",
                   demo("train/muesli/background.jpg"), "--yaw", "0"})
                  .status,
              0);
    const auto store = open_sqlite_store(database());
    RecognizeOptions options;
    options.feature = recorded_options(store->features().value());
    const Recognizer recognizer(store->load(), options);
    for (const std::string& scene : scenes_)
      expected_.push_back(without_times(to_json(recognizer.recognize(read_image(scene)), scene)));
  }

  static Json without_times(Json json) {
    json.erase("time_ms");
    return json;
  }
  static std::vector<Json> lines_of(const std::string& text) {
    std::vector<Json> all;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
      all.push_back(without_times(Json::parse(line)));
    return all;
  }

  const std::vector<std::string> scenes_{demo("test/reading.jpg"), demo("test/breakfast.jpg"),
                                         demo("test/upset.jpg")};
  std::vector<Json> expected_;
};

TEST_F(SameResult, LibraryAndCommand) {
  std::vector<std::string> arguments{"recognize", "--json"};
  arguments.insert(arguments.end(), scenes_.begin(), scenes_.end());
  EXPECT_EQ(lines_of(run(arguments).out), expected_);
  EXPECT_FALSE(expected_[0]["detections"].empty());
}

#ifdef POSEVOTE_WITH_SERVER
TEST_F(SameResult, LibraryAndServer) {
  const ServerProcess server(folder_, {});  // folder_ is where the database lies
  for (std::size_t i = 0; i < scenes_.size(); ++i) {
    const auto answer = server.client().Post("/api/recognize", content(scenes_[i]), "image/jpeg");
    ASSERT_TRUE(answer) << to_string(answer.error());
    Json said = without_times(Json::parse(answer->body));
    said["image"] = scenes_[i];  // a picture that is sent has no file's name
    EXPECT_EQ(said, expected_[i]);
  }
}
#endif

#ifdef POSEVOTE_PYTHON_PACKAGES
TEST_F(SameResult, LibraryAndPython) {
  const std::string script = write("recognize.py", std::string(R"(
import sys
import posevote
with posevote.ObjectStore(sys.argv[1], "read_only") as store:
    recognizer = posevote.Recognizer(store)
for scene in sys.argv[2:]:
    print(recognizer.recognize(posevote.read_image(scene)).to_json(scene))
)"));
  std::string command = "PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='" POSEVOTE_PYTHON_PACKAGES
                        "' '" POSEVOTE_PYTHON_PROGRAM "' '" +
                        script + "' '" + database() + "'";
  for (const std::string& scene : scenes_) command += " '" + scene + "'";
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string text;
  char buffer[4096];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe))
    text.append(buffer, count);
  EXPECT_EQ(pclose(pipe), 0);
  EXPECT_EQ(lines_of(text), expected_);
}
#endif

}  // namespace
}  // namespace posevote
