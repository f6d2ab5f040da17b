// Counters for Prometheus.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <sstream>
#include <string>

#include "posevote/recognize/recognizer.hpp"

namespace posevote::server {

/// Cumulative histogram of seconds. Safe for many threads.
class Histogram {
 public:
  static constexpr std::array kBounds = {0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                         0.1,   0.25,   0.5,   1.0,  2.5,   5.0};
  void observe(double seconds);
  /// Lines of the text format; `labels` as in `stage="detect"` or "".
  void write(std::ostream& out, const std::string& name, const std::string& labels) const;

 private:
  mutable std::mutex mutex_;
  std::array<std::uint64_t, kBounds.size() + 1> counts_{};
  double sum_ = 0;
};

/// What happened since the server began. Safe for many threads.
class Metrics {
 public:
  void count_recognition(const RecognitionResult& result, bool live);
  void count_age(double seconds) { age_.observe(seconds); }
  void count_request(int status);
  void count_skipped(std::int64_t frames) { skipped_ += frames; }
  void count_missed(std::int64_t frames) { missed_ += frames; }
  void count_taught(std::int64_t views) { taught_ += views; }

  [[nodiscard]] std::int64_t skipped() const { return skipped_; }

  void write(std::ostream& out) const;

 private:
  Histogram detect_, match_, vote_, verify_, total_, age_;
  std::atomic<std::int64_t> live_ = 0, uploads_ = 0, features_ = 0, detections_ = 0;
  std::atomic<std::int64_t> skipped_ =
      0;  ///< frames that were not recognised: a newer one was there
  std::atomic<std::int64_t> missed_ = 0;  ///< frames that slow clients did not get
  std::atomic<std::int64_t> taught_ = 0;
  mutable std::mutex mutex_;
  std::map<int, std::int64_t> requests_;  ///< by status
};

/// "# HELP", "# TYPE" and one value.
void write_metric(std::ostream& out, const std::string& name, const char* type, const char* help,
                  double value);

}  // namespace posevote::server
