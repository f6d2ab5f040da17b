// Is the taught silhouette the true one? What background difference makes of each view.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/evaluate/dataset.hpp"
#include "posevote/evaluate/table.hpp"

namespace posevote {

/// A mask against the true one. Shares are relative to the true silhouette's area.
struct SilhouetteFit {
  double iou = 0;           ///< intersection over union
  double wrong_share = 0;   ///< pixels taken that are not the object's
  double shadow_share = 0;  ///< those of them that are darker than the background picture
};

/// `mask` and `truth`: CV_8U, more than 127 is the object; an empty `mask` has nothing. `picture`
/// and `background`: as they were taught from. All of one size. Throws Error{invalid_argument} when
/// they are not.
[[nodiscard]] SilhouetteFit compare_silhouettes(const cv::Mat& mask, const cv::Mat& truth,
                                                const cv::Mat& picture, const cv::Mat& background);

/// A view that was taught by its background and whose true silhouette is known.
struct SilhouetteCase {
  std::string object, image;         ///< the picture's path in the dataset
  std::string truth_mask;            ///< likewise
  SilhouetteFit fit;                 ///< all zero when the view was refused
  std::vector<cv::Point2f> outline;  ///< the taught one, px; empty when the view was refused
  bool refused = false;
};

/// More of the object's area than this taken from its shadow is a flaw.
constexpr double shadow_limit = 0.05;

/// One row that begins with `name`: views, refused, IoU (median, 5th percentile, least), wrong and
/// shadow pixels, views beyond `shadow_limit`. A refused view counts with an IoU of 0. No row
/// without cases.
[[nodiscard]] Table silhouette_table(const std::string& name,
                                     const std::vector<SilhouetteCase>& cases);

/// Those that fit worst first, at most `count`.
[[nodiscard]] std::vector<SilhouetteCase> worst_silhouettes(std::vector<SilhouetteCase> cases,
                                                            std::size_t count);

}  // namespace posevote
