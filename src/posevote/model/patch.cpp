#include "posevote/model/patch.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

constexpr double kSide = 64;  // px; of a square of the object's area
constexpr int kMargin = 2;    // px of surroundings, so that gradients at the rim exist
constexpr int kSolid = 200;   // of 255: pixels that are object nearly all over

}  // namespace

Patch make_patch(const cv::Mat& picture, const cv::Mat& mask) {
  const cv::Mat solid = mask > 0;
  const int area = cv::countNonZero(solid);
  if (area == 0) return {};
  Patch patch;
  patch.scale = std::max(1.0, std::sqrt(area) / kSide);
  const cv::Rect box = cv::boundingRect(solid);
  const cv::Size size(cvCeil(box.width / patch.scale) + 2 * kMargin,
                      cvCeil(box.height / patch.scale) + 2 * kMargin);
  // A pixel of the patch covers a square of the view about the same centre.
  patch.corner = {box.x - kMargin * patch.scale + 0.5 * (patch.scale - 1),
                  box.y - kMargin * patch.scale + 0.5 * (patch.scale - 1)};
  const auto reach = static_cast<int>(kMargin * patch.scale) + 2;
  cv::Mat smooth, smooth_mask;
  const cv::Rect part =
      cv::Rect(box.x - reach, box.y - reach, box.width + 2 * reach, box.height + 2 * reach) &
      cv::Rect({}, picture.size());
  const double sigma = 0.5 * std::sqrt(patch.scale * patch.scale - 1);
  if (sigma > 0.3) {
    cv::GaussianBlur(picture(part), smooth, {}, sigma);
    cv::GaussianBlur(solid(part), smooth_mask, {}, sigma);
  } else {
    smooth = picture(part);
    smooth_mask = solid(part);
  }
  const cv::Matx23d part_from_patch(patch.scale, 0, patch.corner.x - part.x, 0, patch.scale,
                                    patch.corner.y - part.y);
  cv::warpAffine(smooth, patch.pixels, part_from_patch, size,
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  cv::warpAffine(smooth_mask, patch.mask, part_from_patch, size,
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_CONSTANT);
  patch.mask = patch.mask > kSolid;
  return patch;
}

Patch half_of(const Patch& patch) {
  Patch half;
  cv::resize(patch.pixels, half.pixels, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::resize(patch.mask, half.mask, half.pixels.size(), 0, 0, cv::INTER_AREA);
  half.mask = half.mask > kSolid;
  half.scale = 2 * patch.scale;
  half.corner = patch.corner + cv::Point2d(0.5, 0.5) * patch.scale;
  return half;
}

}  // namespace posevote
