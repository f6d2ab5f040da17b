#include "studio/studio.hpp"

#include "posevote/core/error.hpp"

namespace posevote::server {

Studio::Studio(StudioConfig config)
    : version(config.version),
      folder(config.folder),
      limits(config.options.limits),
      settings(config.options, folder.settings_file()),
      catalogue(std::move(config.store), settings, bell),
      access(config.access),
      jobs(limits.jobs, limits.wait_s),
      trash(folder.trash(), limits.undo_s),
      sessions(folder.sessions(), limits, config.report),
      camera(config.sources, {config.folder_fps, limits.megapixels}, bell),
      live(camera, catalogue, settings, metrics, bell),
      report_(config.report) {
  camera.set_options(settings.options().live);
  housekeeper_ = std::thread([this] { housekeeping(); });
}

Studio::~Studio() {
  stop();
}

void Studio::stop() {
  stop_ = true;
  live.stop();
  camera.stop();
  bell.ring();
  if (housekeeper_.joinable()) housekeeper_.join();
}

/// Other programs may change the database; what was left lying is tidied up.
void Studio::housekeeping() {
  std::string last_problem;
  const Bell alarm;  // never rings
  for (int round = 1; !stop_; ++round) {
    static_cast<void>(alarm.wait(0, std::chrono::milliseconds(250)));
    try {
      catalogue.refresh();
      if (round % 40 == 0) {
        sessions.expire();
        trash.expire();
      }
      last_problem.clear();
    } catch (const std::exception& error) {
      if (last_problem != error.what()) report_(error.what());
      last_problem = error.what();
    }
  }
}

}  // namespace posevote::server
