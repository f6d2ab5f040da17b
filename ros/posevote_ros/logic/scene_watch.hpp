// Is something moving before the camera, and is it still what it was?
#pragma once

#include <opencv2/core.hpp>

#include "posevote/core/options.hpp"

namespace posevote::logic {

struct WatchOptions {
  double rest_s = 1;          ///< without motion, before a picture is taken
  double min_difference = 8;  ///< grey levels of 255; a cell that differs by more has changed
  double min_changed_share = 0.005;  ///< share of the picture's cells that makes a change
  void describe(OptionList& list);
};

/// Watches small grey copies (80 cells wide): a cell is the mean of many pixels, so its noise is
/// far below `min_difference`; brightness that changes everywhere alike (exposure) is no change.
/// Not thread-safe.
class SceneWatch {
 public:
  explicit SceneWatch(const WatchOptions& options = {});

  /// The next picture (as in `Extractor::extract`), taken at `time_s`.
  void add(const cv::Mat& picture, double time_s);

  /// Nothing has moved for `rest_s`.
  [[nodiscard]] bool at_rest() const;

  /// The last picture differs from the one that was there when `remember` was called; true when it
  /// never was.
  [[nodiscard]] bool has_changed() const;
  void remember() { remembered_ = last_; }

 private:
  [[nodiscard]] bool differ(const cv::Mat& a, const cv::Mat& b) const;

  WatchOptions options_;
  cv::Mat last_, since_rest_, remembered_;
  double last_s_ = 0, rest_began_s_ = 0;
};

}  // namespace posevote::logic
