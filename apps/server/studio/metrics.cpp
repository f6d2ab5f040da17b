#include "studio/metrics.hpp"

#include <algorithm>
#include <limits>

namespace posevote::server {
namespace {

void head(std::ostream& out, const std::string& name, const char* type, const char* help) {
  out << "# HELP " << name << ' ' << help << "\n# TYPE " << name << ' ' << type << '\n';
}

}  // namespace

void Histogram::observe(double seconds) {
  const auto bucket = std::ranges::lower_bound(kBounds, seconds) - kBounds.begin();
  const std::lock_guard lock(mutex_);
  ++counts_[static_cast<std::size_t>(bucket)];
  sum_ += seconds;
}

void Histogram::write(std::ostream& out, const std::string& name, const std::string& labels) const {
  const std::lock_guard lock(mutex_);
  const std::string comma = labels.empty() ? "" : labels + ",";
  const std::string braces = labels.empty() ? "" : "{" + labels + "}";
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    below += counts_[i];
    out << name << "_bucket{" << comma << "le=\"";
    if (i < kBounds.size())
      out << kBounds[i];
    else
      out << "+Inf";
    out << "\"} " << below << '\n';
  }
  out << name << "_sum" << braces << ' ' << sum_ << '\n'
      << name << "_count" << braces << ' ' << below << '\n';
}

void Metrics::count_recognition(const RecognitionResult& result, bool live) {
  const StageTimes& time = result.time_ms;
  detect_.observe(time.detect / 1000);
  match_.observe(time.match / 1000);
  vote_.observe(time.vote / 1000);
  verify_.observe(time.verify / 1000);
  total_.observe(time.total / 1000);
  ++(live ? live_ : uploads_);
  features_ += result.counts.features;
  detections_ += static_cast<std::int64_t>(result.detections.size());
}

void Metrics::count_request(int status) {
  const std::lock_guard lock(mutex_);
  ++requests_[status];
}

void Metrics::write(std::ostream& out) const {
  const std::string stage = "posevote_stage_seconds";
  head(out, stage, "histogram", "Time of the steps of recognition.");
  detect_.write(out, stage, "stage=\"detect\"");
  match_.write(out, stage, "stage=\"match\"");
  vote_.write(out, stage, "stage=\"vote\"");
  verify_.write(out, stage, "stage=\"verify\"");
  total_.write(out, stage, "stage=\"total\"");
  head(out, "posevote_result_age_seconds", "histogram", "From a frame's arrival to its result.");
  age_.write(out, "posevote_result_age_seconds", "");
  head(out, "posevote_recognitions_total", "counter", "Pictures that were searched.");
  out << "posevote_recognitions_total{of=\"live\"} " << live_
      << "\nposevote_recognitions_total{of=\"upload\"} " << uploads_ << '\n';
  const auto counter = [&](const char* name, const char* help, std::int64_t value) {
    write_metric(out, name, "counter", help, static_cast<double>(value));
  };
  counter("posevote_features_total", "Features found in these pictures.", features_);
  counter("posevote_detections_total", "Objects found in these pictures.", detections_);
  counter("posevote_frames_skipped_total", "Frames not recognised because a newer one was there.",
          skipped_);
  counter("posevote_stream_frames_missed_total", "Frames that slow clients did not get.", missed_);
  counter("posevote_views_taught_total", "Views taught through the server.", taught_);
  head(out, "posevote_http_requests_total", "counter", "Answered requests.");
  const std::lock_guard lock(mutex_);
  for (const auto& [status, count] : requests_)
    out << "posevote_http_requests_total{status=\"" << status << "\"} " << count << '\n';
}

void write_metric(std::ostream& out, const std::string& name, const char* type, const char* help,
                  double value) {
  head(out, name, type, help);
  out.precision(std::numeric_limits<double>::max_digits10);
  out << name << ' ' << value << '\n';
  out.precision(6);
}

}  // namespace posevote::server
