// Does the scene look like the object in every part, not only where features matched?
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "posevote/model/patch.hpp"

namespace posevote {

/// A scene at full, half, quarter ... size, so that objects of any size are compared at their
/// patch's resolution.
class ScenePyramid {
 public:
  /// `image`: 8 or 16 bits, 1, 3 or 4 channels; not copied at full size when it is 8-bit BGR.
  explicit ScenePyramid(const cv::Mat& image);

  /// The scene seen through `scene_from_patch`: CV_8UC3 of that size, and where it lies in the
  /// picture (CV_8U 0/255). `step`: px of the scene per px of the patch.
  void warp(const cv::Matx33d& scene_from_patch, double step, cv::Size size, cv::Mat& pixels,
            cv::Mat& inside) const;

  /// False for grey pictures, also those that are stored as BGR.
  [[nodiscard]] bool has_colour() const noexcept { return colour_; }

 private:
  std::vector<cv::Mat> levels_;  ///< CV_8UC3
  bool colour_ = false;
};

/// How well a view's picture, put into the scene by a pose, agrees with what is there.
struct Agreement {
  double structure = 0;  ///< mean cosine between the gradients of view and scene, -1 ... 1, where
                         ///< the view has an edge
  double structure_near_matches = 0;  ///< the same inside the hull of the matched features
  double colour_difference = 0;  ///< mean sum of differences of the shares of B, G and R, 0 ... 2;
                                 ///< where view or scene are grey a usual value
  double rim = 0;                ///< mean of the clearest edge along the silhouette's rim, 0 ... 1
  double visible = 0;            ///< share of the object inside the picture
};

/// `matched`: the matched features, px of the view. All-zero for an empty patch or an object
/// outside the picture.
[[nodiscard]] Agreement measure_agreement(const Patch& patch, const cv::Matx33d& scene_from_view,
                                          const std::vector<cv::Point2f>& matched,
                                          const ScenePyramid& scene);

}  // namespace posevote
