#include "pictures.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "posevote/core/error.hpp"
#include "posevote/image/read_image.hpp"

namespace posevote::cli {

QuietCodecs::QuietCodecs() {
  std::fflush(stderr);
  standard_error_ = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (standard_error_ >= 0 && nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  if (nowhere >= 0) close(nowhere);
}

QuietCodecs::~QuietCodecs() {
  std::fflush(stderr);
  if (standard_error_ < 0) return;
  dup2(standard_error_, STDERR_FILENO);
  close(standard_error_);
}

LoadedPicture load_picture(const std::string& path) {
  const QuietCodecs quiet;
  LoadedPicture picture;
  picture.encoded = read_bytes(path);
  picture.image = decode_image(picture.encoded, path);
  return picture;
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder))
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw Error(ErrorCode::io, "cannot make folder '" + folder + "': " + error.message());
}

void save_picture(const std::string& path, const cv::Mat& image) {
  std::vector<std::uint8_t> data;
  cv::imencode(std::filesystem::path(path).extension().string(), image, data,
               {cv::IMWRITE_JPEG_QUALITY, 92});
  save_bytes(path, data);
}

void save_bytes(const std::string& path, const std::vector<std::uint8_t>& data) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
  file.close();
  if (!file)
    throw Error(ErrorCode::io,
                "cannot write file '" + path + "'; is the folder writable and the disk not full?");
}

}  // namespace posevote::cli
