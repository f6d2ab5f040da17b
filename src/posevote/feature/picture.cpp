#include "posevote/feature/picture.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "posevote/core/error.hpp"

namespace posevote {

void check_mask(const cv::Mat& image, const cv::Mat& mask) {
  if (mask.empty()) return;
  if (mask.type() != CV_8UC1 || mask.size() != image.size())
    throw Error(ErrorCode::invalid_argument,
                "a mask must be 8-bit grey and as large as its picture (" +
                    std::to_string(image.cols) + "x" + std::to_string(image.rows) + "), not " +
                    cv::typeToString(mask.type()) + " of " + std::to_string(mask.cols) + "x" +
                    std::to_string(mask.rows));
}

bool is_inside_mask(const cv::Mat& mask, float x, float y) {
  if (mask.empty()) return true;
  const int column = std::clamp(static_cast<int>(std::lround(x)), 0, mask.cols - 1);
  const int row = std::clamp(static_cast<int>(std::lround(y)), 0, mask.rows - 1);
  return mask.at<std::uint8_t>(row, column) != 0;
}

bool comes_before(const Keypoint& a, const Keypoint& b) {
  return std::tie(b.response, a.y, a.x, a.scale, a.angle) <
         std::tie(a.response, b.y, b.x, b.scale, b.angle);
}

}  // namespace posevote
