#include "recognition_table.hpp"

#include <cmath>

#include "posevote/evaluate/statistics.hpp"
#include "posevote/evaluate/table.hpp"
#include "posevote/render/annotate.hpp"

namespace posevote::cli {
namespace {

struct Step {
  const char* name;
  double StageTimes::*time;
  int StageCounts::*count;
};

constexpr Step steps[] = {
    {"detect features", &StageTimes::detect, &StageCounts::features},
    {"match", &StageTimes::match, &StageCounts::matched},
    {"Hough clustering", &StageTimes::vote, &StageCounts::clustered},
    {"homography, verification", &StageTimes::verify, &StageCounts::verified}};

std::string whole(double value) {
  return fixed(value, 0);
}

std::string place_of(const cv::Rect2f& box) {
  return whole(box.x) + ", " + whole(box.y) + ", " + whole(box.width) + " x " + whole(box.height);
}

std::string indented(const std::string& text) {
  std::string result;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && c != '\n') result += "  ";
    line_begins = c == '\n';
    result += c;
  }
  return result;
}

template <class Record, class Field>
std::vector<double> column(const std::vector<Record>& records, Field field) {
  std::vector<double> values;
  values.reserve(records.size());
  for (const Record& record : records) values.push_back(static_cast<double>(record.*field));
  return values;
}

}  // namespace

std::string picture_table(const std::string& path, const RecognitionResult& result) {
  Table found;
  found.header = {"object", "sure", "confidence", "inliers", "where (x, y, size)", "view"};
  for (const Detection& detection : result.detections)
    found.rows.push_back({names_of(detection), detection.probability > 0 ? sureness(detection) : "",
                          percent(detection.confidence, 0), std::to_string(detection.inliers),
                          place_of(detection.box), detection.view});
  for (const UnknownRegion& region : result.unknown)
    found.rows.push_back({"(unknown)", "", "", std::to_string(region.features) + " features",
                          place_of(region.box), ""});
  Table time;
  time.header = {"step", "time", "features"};
  for (const Step& step : steps)
    time.rows.push_back({step.name, fixed(result.time_ms.*step.time, 1) + " ms",
                         std::to_string(result.counts.*step.count)});
  time.rows.push_back({"total", fixed(result.time_ms.total, 1) + " ms", ""});
  return path + ", " + std::to_string(result.image_size.width) + " x " +
         std::to_string(result.image_size.height) + "\n" +
         (result.incomplete ? "  out of time before all was looked at\n" : "") +
         (found.rows.empty() ? "  nothing recognised\n" : indented(found.to_text())) + "\n" +
         indented(time.to_text()) + "\n";
}

std::string frame_line(const Moment& moment, const RecognitionResult& result) {
  std::string line = "frame " + std::to_string(moment.frame) + ", " + fixed(moment.time_s, 2) +
                     " s, " + fixed(result.time_ms.total, 1) + " ms, latency " +
                     fixed(moment.latency_ms, 0) + " ms";
  if (moment.per_second > 0) line += ", " + fixed(moment.per_second, 1) + " per second";
  line += result.incomplete ? " (out of time):" : ":";
  if (result.detections.empty()) line += " nothing";
  for (const Detection& detection : result.detections)
    line += "  " + names_of(detection) + " " + sureness(detection) + " at " +
            place_of(detection.box) + ";";
  return line + "\n";
}

void RecognitionTotals::add(const RecognitionResult& result) {
  times_.push_back(result.time_ms);
  counts_.push_back(result.counts);
  detections_ += result.detections.size();
}

void RecognitionTotals::add(const RecognitionTotals& other) {
  times_.insert(times_.end(), other.times_.begin(), other.times_.end());
  counts_.insert(counts_.end(), other.counts_.begin(), other.counts_.end());
  detections_ += other.detections_;
  latencies_.insert(latencies_.end(), other.latencies_.begin(), other.latencies_.end());
  stream_s_ += other.stream_s_;
  dropped_ += other.dropped_;
}

std::string RecognitionTotals::summary() const {
  std::string line = std::to_string(times_.size()) + " pictures, " + std::to_string(detections_) +
                     " detections, median " + fixed(median(column(times_, &StageTimes::total)), 1) +
                     " ms per picture";
  if (!latencies_.empty())
    line += ", " + fixed(static_cast<double>(latencies_.size()) / stream_s_, 1) +
            " per second, latency " + fixed(median(latencies_), 0) +
            " ms (95 %: " + fixed(quantile(latencies_, 0.95), 0) + " ms)";
  if (dropped_ > 0) line += ", " + std::to_string(dropped_) + " frames dropped";
  return line + "\n";
}

std::string RecognitionTotals::steps_table() const {
  Table table;
  table.header = {"step", "median", "95 %", "features"};
  for (const Step& step : steps) {
    const auto times = column(times_, step.time);
    table.rows.push_back({step.name, fixed(median(times), 1) + " ms",
                          fixed(quantile(times, 0.95), 1) + " ms",
                          whole(median(column(counts_, step.count)))});
  }
  const auto totals = column(times_, &StageTimes::total);
  table.rows.push_back(
      {"total", fixed(median(totals), 1) + " ms", fixed(quantile(totals, 0.95), 1) + " ms", ""});
  return table.to_text();
}

}  // namespace posevote::cli
