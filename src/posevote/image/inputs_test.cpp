#include "posevote/image/inputs.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

class Inputs : public testing::Test {
 protected:
  Inputs() { fs::create_directories(folder_); }
  ~Inputs() override { fs::remove_all(folder_); }
  void touch(const std::string& name) const { std::ofstream(folder_ / name) << "x"; }

  fs::path folder_ = fs::temp_directory_path() / ("inputs_test." + std::to_string(getpid()));
};

ErrorCode code_of(const std::string& argument) {
  try {
    static_cast<void>(expand_input(argument));
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::io;
}

TEST_F(Inputs, AFolderGivesItsPicturesSortedAndNothingElse) {
  for (const char* name : {"b.PNG", "a.jpg", "notes.txt", "c.mp4", "noending"}) touch(name);
  fs::create_directory(folder_ / "d.png");
  const auto inputs = expand_input(folder_.string());
  ASSERT_EQ(inputs.size(), 2U);
  EXPECT_EQ(inputs[0].path, (folder_ / "a.jpg").string());
  EXPECT_EQ(inputs[1].path, (folder_ / "b.PNG").string());
  EXPECT_EQ(inputs[0].kind, InputKind::image);
}

TEST_F(Inputs, AFolderWithoutPicturesIsAnError) {
  EXPECT_EQ(code_of(folder_.string()), ErrorCode::not_found);
}

TEST_F(Inputs, FilesAreTakenAsGivenWhetherTheyExistOrNot) {
  const auto image = expand_input("some/where.jpg");
  ASSERT_EQ(image.size(), 1U);
  EXPECT_EQ(image[0].kind, InputKind::image);
  EXPECT_EQ(image[0].path, "some/where.jpg");
  EXPECT_EQ(expand_input("clip.MP4")[0].kind, InputKind::video);
}

TEST_F(Inputs, CamerasAreNumbered) {
  const auto inputs = expand_input("camera:12");
  ASSERT_EQ(inputs.size(), 1U);
  EXPECT_EQ(inputs[0].kind, InputKind::camera);
  EXPECT_EQ(inputs[0].camera, 12);
  for (const char* wrong : {"camera:", "camera:x", "camera:-1", "camera:1x", "camera:99999999999"})
    EXPECT_EQ(code_of(wrong), ErrorCode::invalid_argument) << wrong;
}

}  // namespace
}  // namespace posevote
