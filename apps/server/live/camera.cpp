#include "live/camera.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <thread>

#include "http/problem.hpp"

namespace posevote::server {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr auto kRetry = milliseconds(500), kLook = milliseconds(100);
constexpr double kStale = 30;    // s after which a frame shows nothing of the present
constexpr int kMostHanging = 2;  // attempts at one source

double seconds_since(Clock::time_point when) {
  return std::chrono::duration<double>(Clock::now() - when).count();
}

}  // namespace

/// What outlives the Camera if its source hangs.
struct Camera::Shared {
  std::vector<SourceChoice> choices;
  SourceOptions source_options;
  OpenSource open;
  Clock::time_point begin = Clock::now();
  PostedFrames posted;

  mutable std::mutex mutex;
  std::condition_variable changed;
  Bell* bell = nullptr;  ///< null: nobody listens any more
  std::string source;
  bool stop = false;
  std::int64_t attempt = 0;  ///< the newest; frames of others are not taken
  bool in_hand = false;      ///< it has not failed yet
  Clock::time_point alive = begin, retry = begin;
  std::map<std::string, int> attempts;  ///< that have not ended, by source
  LiveOptions live_options;
  CameraState state = CameraState::waiting;
  std::string message = "waiting for the first frame";
  Clock::time_point since = Clock::now(), last_frame = Clock::now();
  std::shared_ptr<const LiveFrame> newest;
  std::int64_t number = 0, frames = 0, dropped = 0;
  std::deque<Clock::time_point> recent;

  void enter(CameraState next, const std::string& why) {
    if (state != next) since = Clock::now();
    if (state == next && message == why) return;
    state = next;
    message = why;
    if (bell) bell->ring();
  }

  void publish(Frame frame, const std::string& of, std::int64_t by) {
    const std::lock_guard lock(mutex);
    if (stop || attempt != by) return;
    const auto now = Clock::now();
    number += frame.dropped;
    dropped += frame.dropped;
    ++frames;
    newest = std::make_shared<const LiveFrame>(std::move(frame.image), number++,
                                               std::chrono::duration<double>(now - begin).count(),
                                               of, live_options);
    last_frame = alive = now;
    recent.push_back(now);
    while (now - recent.front() > std::chrono::seconds(3)) recent.pop_front();
    enter(CameraState::running, "");
    if (bell) bell->ring();
  }

  std::string address_of(const std::string& name) const {
    return std::ranges::find(choices, name, &SourceChoice::name)->address;
  }

  bool wants(std::int64_t frames_of) const {
    const std::lock_guard lock(mutex);
    return !stop && attempt == frames_of;
  }

  bool silent() const {
    const double time_s = std::max(source_options.silence_s, 2 / source_options.fps);
    return source != "client" && seconds_since(alive) > time_s;
  }

  bool all_ended() const {
    return std::ranges::all_of(attempts, [](const auto& one) { return one.second == 0; });
  }
};

void Camera::look_after(const std::shared_ptr<Shared>& shared) {
  Shared& s = *shared;
  std::unique_lock lock(s.mutex);
  while (!s.stop) {
    const bool silent = s.silent();
    const int hanging = s.attempts[s.source];
    if (silent && hanging > 0)
      s.enter(CameraState::lost, "no frame has come for some time; it is tried again by itself");
    const bool due = !s.in_hand && Clock::now() >= s.retry;
    if ((due && hanging == 0) || (silent && hanging < kMostHanging)) begin(shared);
    s.changed.wait_for(lock, kLook);
  }
}

void Camera::begin(const std::shared_ptr<Shared>& shared) {
  Shared& s = *shared;
  s.in_hand = true;
  s.alive = Clock::now();
  ++s.attempts[s.source];
  std::thread(capture, shared, s.source, ++s.attempt).detach();
}

void Camera::capture(const std::shared_ptr<Shared>& shared, const std::string& source,
                     std::int64_t attempt) {
  Shared& s = *shared;
  std::string reason;
  try {
    const auto frames = s.open(s.address_of(source), s.source_options, s.posted);
    while (s.wants(attempt)) {
      auto frame = frames->next();
      if (!frame) throw Error(ErrorCode::io, "'" + source + "' has come to its end");
      s.publish(std::move(*frame), source, attempt);
    }
  } catch (const std::exception& error) {
    reason = error.what();
  }
  const std::lock_guard lock(s.mutex);
  --s.attempts[source];
  if (s.attempt == attempt && !s.stop) {
    s.in_hand = false;
    s.retry = Clock::now() + kRetry;
    s.enter(source == "client" ? CameraState::waiting : CameraState::lost, reason);
  }
  s.changed.notify_all();
}

Camera::Camera(std::vector<SourceChoice> choices, const SourceOptions& options, Bell& bell,
               OpenSource open)
    : shared_(std::make_shared<Shared>()) {
  if (std::ranges::find(choices, "client", &SourceChoice::name) == choices.end())
    choices.push_back(parse_source("client"));
  shared_->choices = std::move(choices);
  shared_->source_options = options;
  shared_->open = std::move(open);
  shared_->source = shared_->choices.front().name;
  shared_->bell = &bell;
  std::thread(look_after, shared_).detach();
}

Camera::~Camera() {
  stop();
}

void Camera::stop() {
  std::unique_lock lock(shared_->mutex);
  shared_->stop = true;
  shared_->bell = nullptr;
  shared_->changed.notify_all();
  shared_->posted.interrupt();
  // A driver may hang; the process ends nevertheless.
  shared_->changed.wait_for(lock, std::chrono::seconds(3), [this] { return shared_->all_ended(); });
}

std::vector<std::string> Camera::choices() const {
  std::vector<std::string> names;
  for (const SourceChoice& choice : shared_->choices) names.push_back(choice.name);
  return names;
}

void Camera::select(const std::string& source) {
  if (std::ranges::find(shared_->choices, source, &SourceChoice::name) == shared_->choices.end())
    throw invalid("'" + source + "' is none of the sources that this server was started with");
  const std::lock_guard lock(shared_->mutex);
  if (shared_->source == source) return;
  shared_->source = source;
  shared_->newest = nullptr;
  shared_->recent.clear();
  ++shared_->attempt;  // the one before is not wanted any more
  shared_->in_hand = false;
  shared_->alive = shared_->retry = shared_->last_frame = Clock::now();
  shared_->enter(CameraState::waiting, "waiting for the first frame");
  shared_->changed.notify_all();
  shared_->posted.interrupt();
}

CameraStatus Camera::status() const {
  const std::lock_guard lock(shared_->mutex);
  CameraStatus status{shared_->source, shared_->state, shared_->message,
                      seconds_since(shared_->since)};
  const auto& recent = shared_->recent;
  if (recent.size() > 1 && seconds_since(recent.back()) < 3)
    status.fps =
        static_cast<double>(recent.size() - 1) / std::max(1e-3, seconds_since(recent.front()));
  status.frames = shared_->frames;
  status.dropped = shared_->dropped;
  return status;
}

std::shared_ptr<const LiveFrame> Camera::newest() const {
  const std::lock_guard lock(shared_->mutex);
  return seconds_since(shared_->last_frame) > kStale ? nullptr : shared_->newest;
}

void Camera::set_options(const LiveOptions& options) {
  const std::lock_guard lock(shared_->mutex);
  shared_->live_options = options;
}

std::int64_t Camera::post(cv::Mat image) {
  std::int64_t number = 0;
  {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->source != "client")
      throw conflict("the source is '" + shared_->source + "'; choose 'client' first");
    number = shared_->number;
  }
  shared_->posted.post(std::move(image));
  return number;
}

double Camera::now_s() const {
  return seconds_since(shared_->begin);
}

}  // namespace posevote::server
