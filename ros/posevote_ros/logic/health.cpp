#include "logic/health.hpp"

#include <algorithm>

namespace posevote::logic {

void Health::add(double now_s, double stamp_s, double time_ms, std::uint64_t dropped) {
  // A clock that was set back (a bag played again) begins anew.
  if (!recent_.empty() && now_s < recent_.back().at_s) recent_.clear();
  recent_.push_back({now_s, (now_s - stamp_s) * 1e3, time_ms});
  while (recent_.front().at_s < now_s - window_s_) recent_.pop_front();
  ++totals_.pictures;
  totals_.dropped += dropped;
  totals_.last_problem.clear();
}

void Health::add_problem(const std::string& problem) {
  ++totals_.refused;
  totals_.last_problem = problem;
}

HealthReport Health::report(double now_s) const {
  HealthReport report = totals_;
  int count = 0;
  for (const Done& done : recent_) {
    if (done.at_s < now_s - window_s_ || done.at_s > now_s) continue;
    ++count;
    report.mean_time_ms += done.time_ms;
    report.mean_latency_ms += done.latency_ms;
    report.worst_latency_ms = std::max(report.worst_latency_ms, done.latency_ms);
  }
  if (count == 0) return report;
  report.mean_time_ms /= count;
  report.mean_latency_ms /= count;
  report.rate_hz = count / window_s_;
  return report;
}

}  // namespace posevote::logic
