// Feeds a TeachSession with a camera's pictures until it is done, cancelled or given up.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "logic/latest.hpp"
#include "logic/teach_session.hpp"
#include "posevote/core/error.hpp"

namespace posevote::logic {

/// Empty when it cannot be read.
template <class Frame>
[[nodiscard]] cv::Mat picture_or_nothing(const Frame& frame) {
  try {
    return frame.picture();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::unreadable_image) throw;
    return {};
  }
}

/// `Frame`: a picture as it came, with `cv::Mat picture() const`, which may throw
/// Error{unreadable_image}: such a frame is passed over.
template <class Frame>
struct TeachLoop {
  Latest<Frame>& frames;
  std::string camera;     ///< for messages
  double patience_s = 0;  ///< to wait for progress; 0: 120 s
  std::function<double(const Frame&)> time_s;
  std::function<bool()> captured;  ///< was `capture` called since the last time?
  std::function<bool()> cancelled;
  /// `frame`: the one that made the progress; null at the beginning.
  std::function<void(const TeachProgress& progress, const Frame* frame)> report;

  /// Throws Error{io} when patience ends, and what the session throws.
  TeachProgress run(TeachSession& session) {
    using Clock = std::chrono::steady_clock;
    const std::chrono::duration<double> patience(patience_s > 0 ? patience_s : 120);
    std::uint64_t seen = frames.number();
    auto last_progress = Clock::now();
    report(session.progress(), nullptr);
    while (!session.finished() && !cancelled()) {
      if (Clock::now() - last_progress > patience)
        throw Error(ErrorCode::io, "no view could be taken from '" + camera +
                                       "' in time, at the step '" + session.progress().step + "'");
      const auto frame = frames.wait_newer(seen, std::chrono::milliseconds(100));
      if (!frame) continue;
      if (captured()) session.capture();
      const cv::Mat picture = picture_or_nothing(*frame);
      if (picture.empty() || !session.offer(picture, time_s(*frame))) continue;
      last_progress = Clock::now();
      report(session.progress(), &*frame);
    }
    return session.progress();
  }
};

}  // namespace posevote::logic
