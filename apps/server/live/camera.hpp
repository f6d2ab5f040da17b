// The live source: captures in threads of its own, says when frames stay away, and tries again.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "live/bell.hpp"
#include "live/frame.hpp"
#include "live/sources.hpp"

namespace posevote::server {

enum class CameraState { waiting, running, lost };

struct CameraStatus {
  std::string source;
  CameraState state = CameraState::waiting;
  std::string message;  ///< why there are no frames; empty when running
  double since_s = 0;   ///< seconds in this state
  double fps = 0;
  std::int64_t frames = 0;   ///< arrived since the beginning
  std::int64_t dropped = 0;  ///< left out by the source, because they came too fast
};

using OpenSource = std::function<decltype(open_source)>;

/// Safe for many threads. A source that hangs, whether it is opened or read, is left to itself:
/// another attempt, or another source, does not wait for it.
class Camera {
 public:
  /// The first of `choices` is opened; "client" is always one of them. Rings `bell` for each frame
  /// and each change of state. `open`: called from several threads.
  Camera(std::vector<SourceChoice> choices, const SourceOptions& options, Bell& bell,
         OpenSource open = open_source);
  /// Gives up a source that does not come to an end within some seconds.
  ~Camera();

  /// Takes no more frames, as the destructor does.
  void stop();

  [[nodiscard]] std::vector<std::string> choices() const;  ///< their names
  /// Throws Problem 400 for a source that is no choice.
  void select(const std::string& source);
  [[nodiscard]] CameraStatus status() const;
  /// Null before the first frame, and from half a minute after the last one.
  [[nodiscard]] std::shared_ptr<const LiveFrame> newest() const;
  void set_options(const LiveOptions& options);

  /// A client's frame; throws Problem 409 while the source is another. Returns the number that it
  /// will have if no other comes before it.
  std::int64_t post(cv::Mat image);

  /// Seconds since the server began: the clock of frames and results.
  [[nodiscard]] double now_s() const;

 private:
  struct Shared;
  static void look_after(const std::shared_ptr<Shared>& shared);
  static void begin(const std::shared_ptr<Shared>& shared);
  static void capture(const std::shared_ptr<Shared>& shared, const std::string& source,
                      std::int64_t attempt);
  std::shared_ptr<Shared> shared_;
};

}  // namespace posevote::server
