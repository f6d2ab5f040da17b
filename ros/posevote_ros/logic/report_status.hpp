// What the diagnostics say of the node; `Status` is either ROS's DiagnosticStatusWrapper.
#pragma once

#include <string>

#include "logic/health.hpp"
#include "logic/object_recognition.hpp"

namespace posevote::logic {

template <class Status>
void report_health(Status& status, const HealthReport& report, double slow_ms, bool listened_to) {
  if (!report.last_problem.empty())
    status.summary(Status::WARN, report.last_problem);
  else if (report.worst_latency_ms > slow_ms)
    status.summary(Status::WARN, "results come late");
  else
    status.summary(Status::OK, listened_to ? "recognising" : "nobody listens");
  status.add("rate (Hz)", report.rate_hz);
  status.add("mean time (ms)", report.mean_time_ms);
  status.add("mean latency (ms)", report.mean_latency_ms);
  status.add("worst latency (ms)", report.worst_latency_ms);
  status.add("pictures", report.pictures);
  status.add("dropped for newer ones", report.dropped);
  status.add("refused", report.refused);
}

template <class Status>
void report_database(Status& status, const DatabaseState& database) {
  if (!database.problem.empty())
    status.summary(Status::WARN, database.problem);
  else if (database.objects.empty())
    status.summary(Status::WARN, "no objects are taught yet");
  else
    status.summary(Status::OK, std::to_string(database.objects.size()) + " objects");
  status.add("location", database.location);
  status.add("version", database.version);
  status.add("features", database.features);
  status.add("read only", database.read_only);
}

}  // namespace posevote::logic
