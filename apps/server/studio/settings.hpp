// The options that people change while the server runs, kept over a restart.
#pragma once

#include <mutex>
#include <string>

#include "http/limits.hpp"
#include "live/live_options.hpp"
#include "posevote/json/recognition_json.hpp"
#include "posevote/recognize/recognizer.hpp"
#include "posevote/teach/teacher.hpp"

namespace posevote::server {

/// Everything that can be set for the server; "recognize.", "teach.", "live.", "limits." in names.
struct StudioOptions {
  RecognizeOptions recognize;
  TeachOptions teach;
  LiveOptions live;
  Limits limits;
  void describe(OptionList& list);
};

/// Safe for many threads.
class Settings {
 public:
  /// `base`: the defaults. `file`: where changes are kept; it is read if it is there. What it holds
  /// that this version does not know is left out.
  Settings(StudioOptions base, std::string file);

  [[nodiscard]] StudioOptions options() const;
  /// Grows with every change.
  [[nodiscard]] int generation() const;

  /// {"settings": [...]}: see Setting in openapi.yaml. Limits are not among them.
  [[nodiscard]] Json json() const;

  /// Sets {"name": value or null, ...}, all or nothing. Throws Error{invalid_argument} for what
  /// cannot be set, Error{io} when it cannot be kept.
  void change(const Json& changes);

 private:
  void save(const StudioOptions& changed) const;

  const StudioOptions base_;
  const std::string file_;
  mutable std::mutex mutex_;
  StudioOptions options_;
  int generation_ = 0;
};

}  // namespace posevote::server
