#include "studio/settings.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "posevote/core/error.hpp"
#include "posevote/verify/verifier.hpp"

namespace posevote::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDial = "recognize.verify.false_alarms_per_1000_images";

class SettingsTest : public testing::Test {
 protected:
  ~SettingsTest() override { fs::remove(file_); }

  Settings open() const { return {StudioOptions(), file_}; }

  static Json value(const Settings& settings, const std::string& name) {
    const Json all = settings.json();
    for (const Json& one : all["settings"])
      if (one["name"] == name) return one["value"];
    return "none of that name";
  }

  std::string file_ =
      (fs::temp_directory_path() / ("posevote-settings-" + std::to_string(getpid()))).string();
};

TEST_F(SettingsTest, TheDialComesFirstAndEveryOneIsExplained) {
  const Json all = open().json()["settings"];
  EXPECT_EQ(all[0]["name"], kDial);
  EXPECT_EQ(all[0]["level"], "basic");
  for (const Json& one : all) {
    EXPECT_FALSE(one["help"].get<std::string>().empty()) << one["name"];
    EXPECT_EQ(one["value"], one["default"]) << one["name"];
  }
}

TEST_F(SettingsTest, ChangesAreKept) {
  Settings settings = open();
  settings.change({{kDial, 0.25}, {"live.stream_width", 320}});
  EXPECT_EQ(settings.options().recognize.verify.false_alarms_per_1000_images, 0.25);
  EXPECT_EQ(value(open(), kDial), 0.25);
  EXPECT_EQ(value(open(), "live.stream_width"), 320);
  settings.change({{kDial, nullptr}});
  EXPECT_EQ(value(open(), kDial), VerifyOptions().false_alarms_per_1000_images);
  EXPECT_EQ(settings.generation(), 2);
}

TEST_F(SettingsTest, AllOrNothing) {
  Settings settings = open();
  for (const Json& bad : std::vector<Json>{{{kDial, 0.25}, {"live.max_fps", -1}},
                                           {{kDial, 0.25}, {"live.no_such", 1}},
                                           {{kDial, 0.25}, {"live.no_such", nullptr}},
                                           {{kDial, "much"}},
                                           {{kDial, {1, 2}}},
                                           {{"recognize.feature.max_features", 5}},
                                           {{"limits.sessions", 5}}}) {
    EXPECT_THROW(settings.change(bad), Error) << bad;
    EXPECT_EQ(value(settings, kDial), VerifyOptions().false_alarms_per_1000_images);
  }
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(SettingsTest, AFileOfAnotherVersionOrNoneAtAll) {
  std::ofstream(file_) << R"({"live.gone": 1, "live.max_fps": 7, "live.stream_width": -5})";
  EXPECT_EQ(open().options().live.max_fps, 7);
  EXPECT_EQ(open().options().live.stream_width, LiveOptions().stream_width);
  std::ofstream(file_) << "garbage";
  EXPECT_EQ(open().options().live.max_fps, LiveOptions().max_fps);
}

}  // namespace
}  // namespace posevote::server
