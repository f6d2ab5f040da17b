// Everything that requests are answered from.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "http/access.hpp"
#include "live/live_recognition.hpp"
#include "studio/catalogue.hpp"
#include "studio/files.hpp"
#include "studio/job_slots.hpp"
#include "studio/metrics.hpp"
#include "studio/settings.hpp"
#include "studio/teach_sessions.hpp"
#include "studio/trash.hpp"

namespace posevote::server {

struct StudioConfig {
  std::unique_ptr<ObjectStore> store;
  std::string folder;                 ///< see StudioFolder; made when it is not there
  StudioOptions options;              ///< what settings begin with
  std::vector<SourceChoice> sources;  ///< none: "client" alone
  double folder_fps = 5;
  AccessOptions access;
  std::string version;                             ///< of the program
  std::function<void(const std::string&)> report;  ///< told of what people should know
};

/// Members are made in this order and end in the reverse one.
struct Studio {
  explicit Studio(StudioConfig config);
  ~Studio();

  /// Frames are neither taken nor recognised any more.
  void stop();

  const std::string version;
  const StudioFolder folder;
  const Limits limits;
  Bell bell;  ///< rings whenever something changed that clients watch
  Settings settings;
  Catalogue catalogue;
  Metrics metrics;
  AccessControl access;
  JobSlots jobs;
  Trash trash;
  TeachSessions sessions;
  Camera camera;
  LiveRecognition live;
  std::atomic<int> streams = 0;  ///< clients that watch frames or events

 private:
  void housekeeping();

  std::function<void(const std::string&)> report_;
  std::atomic<bool> stop_ = false;
  std::thread housekeeper_;
};

}  // namespace posevote::server
