// Recognises the newest frame again and again, once for all clients.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

#include "live/camera.hpp"
#include "rate_meter.hpp"
#include "studio/catalogue.hpp"
#include "studio/metrics.hpp"

namespace posevote::server {

/// Immutable but for the drawn picture, which is made when the first client needs it.
class LiveResult {
 public:
  LiveResult(std::shared_ptr<const LiveFrame> frame, RecognitionResult result, double age_ms);

  [[nodiscard]] const LiveFrame& frame() const { return *frame_; }
  [[nodiscard]] const RecognitionResult& result() const { return result_; }
  [[nodiscard]] const Json& json() const { return json_; }         ///< Recognition of openapi.yaml
  [[nodiscard]] const std::string& text() const { return text_; }  ///< the same in one line
  /// The frame with the results drawn in, as large as frames are streamed.
  [[nodiscard]] const Bytes& annotated_jpeg(const LiveOptions& options) const;

 private:
  std::shared_ptr<const LiveFrame> frame_;
  RecognitionResult result_;
  Json json_;
  std::string text_;
  mutable std::once_flag once_;
  mutable Bytes annotated_;
};

class LiveRecognition {
 public:
  /// Rings `bell` for each result. Everything must outlive it.
  LiveRecognition(Camera& camera, const Catalogue& catalogue, const Settings& settings,
                  Metrics& metrics, Bell& bell);
  ~LiveRecognition();

  /// Ends when the frame in hand is done.
  void stop();

  /// Null before the first result, and when the camera is lost or recognition is switched off. From
  /// a client that fell silent the result of the last frame is shown as long as the frame is.
  [[nodiscard]] std::shared_ptr<const LiveResult> newest() const;
  /// The frame of that number, if it was among the last that were recognised.
  [[nodiscard]] std::shared_ptr<const LiveFrame> recent(std::int64_t number) const;
  [[nodiscard]] double fps() const;

 private:
  void run();
  void recognize(const std::shared_ptr<const LiveFrame>& frame);
  void remember(std::shared_ptr<const LiveFrame> frame);

  Camera& camera_;
  const Catalogue& catalogue_;
  const Settings& settings_;
  Metrics& metrics_;
  Bell& bell_;
  std::atomic<bool> stop_ = false;
  mutable std::mutex mutex_;
  std::shared_ptr<const LiveResult> newest_;
  std::deque<std::shared_ptr<const LiveFrame>> recent_;
  mutable RateMeter rate_;
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace posevote::server
