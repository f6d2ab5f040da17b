// The server's own files beside the database.
#pragma once

#include <string>

namespace posevote::server {

/// The folder in which a server keeps settings, teach sessions in hand and what can be undone; only
/// its owner may look into it. Locked while it lives.
class StudioFolder {
 public:
  /// Makes it. Throws Error{io} when it cannot be made, and when another server uses it.
  explicit StudioFolder(std::string folder);
  ~StudioFolder();
  StudioFolder(const StudioFolder&) = delete;
  StudioFolder& operator=(const StudioFolder&) = delete;

  [[nodiscard]] std::string settings_file() const { return folder_ + "/settings.json"; }
  [[nodiscard]] std::string sessions() const { return folder_ + "/sessions"; }
  [[nodiscard]] std::string trash() const { return folder_ + "/undo"; }

 private:
  std::string folder_;
  int lock_ = -1;
};

/// Replaces the file as a whole or not at all. Throws Error{io}.
void write_file(const std::string& path, const std::string& content);

/// Removes the file, if it is there, with a database's companions.
void remove_database_file(const std::string& path);

}  // namespace posevote::server
