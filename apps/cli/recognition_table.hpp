// Recognition results for people: tables like the paper's Table I.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "posevote/recognize/recognizer.hpp"

namespace posevote::cli {

/// What was found in a picture and where, then time and number of features of every step.
[[nodiscard]] std::string picture_table(const std::string& path, const RecognitionResult& result);

/// One line for a frame of a stream.
[[nodiscard]] std::string frame_line(std::int64_t number, double time_s,
                                     const RecognitionResult& result);

/// Times and counts over many pictures.
class RecognitionTotals {
 public:
  void add(const RecognitionResult& result);
  void add(const RecognitionTotals& other);
  void add_dropped(std::int64_t frames) { dropped_ += frames; }

  [[nodiscard]] std::size_t pictures() const { return times_.size(); }
  /// One line: pictures, detections, median time, dropped frames.
  [[nodiscard]] std::string summary() const;
  /// Median and 95th percentile of the time of every step, and the median counts.
  [[nodiscard]] std::string steps_table() const;
  [[nodiscard]] const std::vector<StageTimes>& times() const { return times_; }
  [[nodiscard]] const std::vector<StageCounts>& counts() const { return counts_; }

 private:
  std::vector<StageTimes> times_;
  std::vector<StageCounts> counts_;
  std::size_t detections_ = 0;
  std::int64_t dropped_ = 0;
};

}  // namespace posevote::cli
