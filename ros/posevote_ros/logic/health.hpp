// How the node fares: what diagnostics report.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace posevote::logic {

struct HealthReport {
  double rate_hz = 0;          ///< pictures recognised per second, over the last `window_s`
  double mean_time_ms = 0;     ///< that recognition took
  double mean_latency_ms = 0;  ///< from the picture's stamp to the result
  double worst_latency_ms = 0;
  std::uint64_t pictures = 0;  ///< since the start
  std::uint64_t dropped = 0;   ///< passed over since the start, because newer ones came
  std::uint64_t refused = 0;   ///< could not be used
  std::string last_problem;    ///< why the last one could not; "" after a good one
};

/// Counts pictures. Times are seconds of one clock that the caller reads. Not thread-safe.
class Health {
 public:
  explicit Health(double window_s = 10) : window_s_(window_s) {}

  /// A picture was recognised: result ready at `now_s`, taken at `stamp_s`, in `time_ms`.
  void add(double now_s, double stamp_s, double time_ms, std::uint64_t dropped);
  void add_problem(const std::string& problem);
  [[nodiscard]] HealthReport report(double now_s) const;

 private:
  struct Done {
    double at_s, latency_ms, time_ms;
  };
  double window_s_;
  std::deque<Done> recent_;
  HealthReport totals_;
};

}  // namespace posevote::logic
