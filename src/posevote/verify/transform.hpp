// Planar transforms view -> scene: fitting, applying, and whether a camera could have made them.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"

namespace posevote {

/// Degrees of freedom 4, 6, 8; points needed 2, 3, 4.
enum class TransformKind { similarity, affine, homography };

[[nodiscard]] int points_needed(TransformKind kind) noexcept;

/// A pair of points; px of the view and of the scene.
struct PointPair {
  cv::Point2f view, scene;
};

/// Least-squares transform (similarity: orientation kept, never mirrored; homography: smallest
/// reprojection error). (2,2) = 1. All-zero when there are too few pairs or they are degenerate.
[[nodiscard]] cv::Matx33d fit_transform(TransformKind kind, const std::vector<PointPair>& pairs);

/// The scene point of a view point; NaN when it lies at or behind the horizon (w <= 0).
[[nodiscard]] cv::Point2f transform_point(const cv::Matx33d& scene_from_view, cv::Point2f point);

/// Derivative of the transform at a point: how a small patch is scaled, turned and sheared.
[[nodiscard]] cv::Matx22d local_jacobian(const cv::Matx33d& scene_from_view, cv::Point2f point);

/// The polygon in the scene; empty when a corner lies at or behind the horizon.
[[nodiscard]] std::vector<cv::Point2f> transform_polygon(const cv::Matx33d& scene_from_view,
                                                         const std::vector<cv::Point2f>& polygon);

struct PlausibilityOptions {
  double max_anisotropy = 4;                ///< largest / smallest stretch at the centre
  double max_perspective = 3;               ///< largest / smallest area scale over the outline
  double min_scale = 0.05, max_scale = 20;  ///< scene px per view px at the centre
  void describe(OptionList& list);
};

/// "" when `scene_from_view` can be a picture of the outline's inside; else the reason in words:
/// not finite, mirrored, folded over, too skewed, too strong perspective, too small, too large.
[[nodiscard]] std::string why_implausible(const cv::Matx33d& scene_from_view,
                                          const std::vector<cv::Point2f>& outline,
                                          const PlausibilityOptions& options);

}  // namespace posevote
