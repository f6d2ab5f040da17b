#include "live/live_recognition.hpp"

#include <algorithm>
#include <cmath>

#include "posevote/render/annotate.hpp"

namespace posevote::server {
namespace {

using std::chrono::milliseconds;

// What people click on is a little older than the newest result.
constexpr std::size_t kMostRecent = 64;
constexpr std::size_t kMostRecentBytes = 64'000'000;

std::size_t bytes_of(const LiveFrame& frame) {
  return frame.image().total() * frame.image().elemSize();
}

}  // namespace

LiveResult::LiveResult(std::shared_ptr<const LiveFrame> frame, RecognitionResult result,
                       double age_ms)
    : frame_(std::move(frame)),
      result_(std::move(result)),
      json_(to_json(result_, frame_->source())) {
  json_["frame"] = frame_->number();
  json_["time_s"] = frame_->time_s();
  json_["age_ms"] = std::round(age_ms * 100) / 100;
  text_ = to_line(json_);
}

const Bytes& LiveResult::annotated_jpeg(const LiveOptions& options) const {
  std::call_once(once_, [&] {
    const cv::Mat drawn = annotate(frame_->image(), result_);
    annotated_ = encode_jpeg(reduced_to(drawn, options.stream_width), options.stream_quality);
  });
  return annotated_;
}

LiveRecognition::LiveRecognition(Camera& camera, const Catalogue& catalogue,
                                 const Settings& settings, Metrics& metrics, Bell& bell)
    : camera_(camera),
      catalogue_(catalogue),
      settings_(settings),
      metrics_(metrics),
      bell_(bell),
      thread_([this] { run(); }) {}

LiveRecognition::~LiveRecognition() {
  stop();
}

void LiveRecognition::stop() {
  stop_ = true;
  bell_.ring();
  if (thread_.joinable()) thread_.join();
}

void LiveRecognition::run() {
  std::int64_t last = -1;
  std::uint64_t seen = 0;
  double due_s = 0;
  while (!stop_) {
    const LiveOptions options = settings_.options().live;
    const auto frame = camera_.newest();
    const double now_s = camera_.now_s();
    if (!options.recognize || !frame || frame->number() == last || now_s < due_s) {
      const double until_due = std::clamp(due_s - now_s, 0.0, 0.5);
      const bool only_early = options.recognize && frame && frame->number() != last;
      seen = bell_.wait(
          only_early ? bell_.rings() : seen,
          only_early ? milliseconds(std::lround(std::ceil(until_due * 1000))) : milliseconds(500));
      continue;
    }
    if (last >= 0) metrics_.count_skipped(std::max<std::int64_t>(0, frame->number() - last - 1));
    last = frame->number();
    due_s = std::max(due_s + 1 / options.max_fps, now_s);
    recognize(frame);
  }
}

void LiveRecognition::recognize(const std::shared_ptr<const LiveFrame>& frame) {
  RecognitionResult result = catalogue_.recognizer()->recognize(frame->image());
  metrics_.count_recognition(result, true);
  const double now_s = camera_.now_s(), age_s = now_s - frame->time_s();
  metrics_.count_age(age_s);
  auto made = std::make_shared<const LiveResult>(frame, std::move(result), 1000 * age_s);
  rate_.count(now_s);
  remember(frame);
  {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(made);
  }
  bell_.ring();
}

void LiveRecognition::remember(std::shared_ptr<const LiveFrame> frame) {
  const std::lock_guard lock(mutex_);
  recent_.push_back(std::move(frame));
  std::size_t bytes = 0;
  for (const auto& kept : recent_) bytes += bytes_of(*kept);
  while (recent_.size() > 1 && (recent_.size() > kMostRecent || bytes > kMostRecentBytes)) {
    bytes -= bytes_of(*recent_.front());
    recent_.pop_front();
  }
}

std::shared_ptr<const LiveResult> LiveRecognition::newest() const {
  if (!settings_.options().live.recognize) return nullptr;
  const CameraState state = camera_.status().state;
  const auto frame = camera_.newest();
  const std::lock_guard lock(mutex_);
  const bool waits_with_it =
      state == CameraState::waiting && newest_ && frame.get() == &newest_->frame();
  return state == CameraState::running || waits_with_it ? newest_ : nullptr;
}

std::shared_ptr<const LiveFrame> LiveRecognition::recent(std::int64_t number) const {
  const std::lock_guard lock(mutex_);
  for (const auto& frame : recent_)
    if (frame->number() == number) return frame;
  return nullptr;
}

double LiveRecognition::fps() const {
  return rate_.per_second(camera_.now_s());
}

}  // namespace posevote::server
