// Recognition results for people: tables like the paper's Table I.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "posevote/recognize/recognizer.hpp"

namespace posevote::cli {

/// What was found in a picture and where, then time and number of features of every step.
[[nodiscard]] std::string picture_table(const std::string& path, const RecognitionResult& result);

/// Where in a stream a result comes from, and whether it keeps up.
struct Moment {
  std::int64_t frame = -1;  ///< -1: a single picture
  double time_s = 0;
  double latency_ms = 0;  ///< from the arrival of the frame to the result
  double per_second = 0;  ///< results; 0: not known yet
};

/// One line for a frame of a stream.
[[nodiscard]] std::string frame_line(const Moment& moment, const RecognitionResult& result);

/// Times and counts over many pictures.
class RecognitionTotals {
 public:
  void add(const RecognitionResult& result);
  void add(const RecognitionTotals& other);
  void add_dropped(std::int64_t frames) { dropped_ += frames; }
  void add_latency(double ms) { latencies_.push_back(ms); }
  void add_stream_time(double seconds) { stream_s_ += seconds; }

  [[nodiscard]] std::size_t pictures() const { return times_.size(); }
  /// One line: pictures, detections, median time; of streams rate, latency and dropped frames.
  [[nodiscard]] std::string summary() const;
  /// Median and 95th percentile of the time of every step, and the median counts.
  [[nodiscard]] std::string steps_table() const;
  [[nodiscard]] const std::vector<StageTimes>& times() const { return times_; }
  [[nodiscard]] const std::vector<StageCounts>& counts() const { return counts_; }

 private:
  std::vector<StageTimes> times_;
  std::vector<StageCounts> counts_;
  std::vector<double> latencies_;  ///< ms, of streams
  double stream_s_ = 0;
  std::size_t detections_ = 0;
  std::int64_t dropped_ = 0;
};

}  // namespace posevote::cli
