#include "studio/files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "posevote/core/error.hpp"

namespace posevote::server {
namespace {

namespace fs = std::filesystem;

void make_private_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) fs::permissions(folder, fs::perms::owner_all, error);
  if (error) throw Error(ErrorCode::io, "cannot make folder '" + folder + "': " + error.message());
}

}  // namespace

StudioFolder::StudioFolder(std::string folder) : folder_(std::move(folder)) {
  make_private_folder(folder_);
  lock_ = open((folder_ + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock_ < 0) throw Error(ErrorCode::io, "cannot write into folder '" + folder_ + "'");
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    close(lock_);
    throw Error(ErrorCode::io,
                "another posevote serve uses folder '" + folder_ + "'; end it first");
  }
  make_private_folder(sessions());
  make_private_folder(trash());
}

StudioFolder::~StudioFolder() {
  close(lock_);
}

void write_file(const std::string& path, const std::string& content) {
  const std::string part = path + ".part";
  const auto fail = [&] {
    throw Error(ErrorCode::io, "cannot write file '" + path + "': " + std::strerror(errno));
  };
  const int file = open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) fail();
  const bool written =
      write(file, content.data(), content.size()) == static_cast<ssize_t>(content.size()) &&
      fsync(file) == 0;
  close(file);
  if (!written || rename(part.c_str(), path.c_str()) != 0) fail();
}

void remove_database_file(const std::string& path) {
  std::error_code ignored;
  for (const char* suffix : {"", "-journal", "-wal", "-shm"}) fs::remove(path + suffix, ignored);
}

}  // namespace posevote::server
