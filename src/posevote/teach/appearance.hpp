// How likely a pixel's colour is if it shows the background, lit or in shadow, and if it shows the
// object.
#pragma once

#include <opencv2/core.hpp>

#include "posevote/teach/photometry.hpp"

namespace posevote {

/// Shadow model. A shadow multiplies the background by a shading s that is the same for all three
/// channels up to a tint, changes slowly compared with texture, and lies in [deepest, 1].
struct ShadowOptions {
  double deepest = 0.12;     ///< share of the (gamma-coded) brightness left in the darkest shadow
  double tint = 0.04;        ///< relative change of chromaticity: sky light, light thrown back
  double brighter = 0.06;    ///< sd by which the object may also brighten its surroundings
  double unevenness = 0.06;  ///< sd of the shading within its window: edges of shadows
  double window_px = 4;      ///< sd of the window that shading is measured in
  void describe(class OptionList& list);
};

/// The background's shading at every pixel (CV_32F), in a Gaussian window. `weight` (CV_32F, in
/// [0, 1]) says how much each pixel is background; where no weight is near, the shading is 1.
[[nodiscard]] cv::Mat estimate_shading(const cv::Mat& picture, const cv::Mat& expected,
                                       const cv::Mat& variance, const cv::Mat& weight,
                                       const ShadowOptions& options);

/// log p(colour | background), CV_32F; density per cubic level.
[[nodiscard]] cv::Mat background_log_likelihood(const cv::Mat& picture, const cv::Mat& expected,
                                                const cv::Mat& variance, const cv::Mat& shading,
                                                const ShadowOptions& options);

/// log p(colour | a plain surface that fills the window), CV_32F: the colour's mean in the window
/// takes the place of the shaded background, with the same tolerances. Against this alternative the
/// background must win by its own texture and exact brightness, not by being plain.
[[nodiscard]] cv::Mat plain_log_likelihood(const cv::Mat& picture, const cv::Mat& variance,
                                           const ShadowOptions& options);

/// Colours of the object: a smoothed 3-D histogram mixed with "any colour".
class ObjectColours {
 public:
  ObjectColours() = default;  ///< any colour is equally likely
  /// Learns from the pixels where `sure` (CV_8U) is set.
  ObjectColours(const cv::Mat& picture, const cv::Mat& sure);
  /// log p(colour | object), CV_32F; density per cubic level.
  [[nodiscard]] cv::Mat log_likelihood(const cv::Mat& picture) const;

 private:
  cv::Mat histogram_;  // 3-D, CV_32F, density per cubic level
};

}  // namespace posevote
