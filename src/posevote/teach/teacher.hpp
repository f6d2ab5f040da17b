// From a picture of an object to a taught View (paper, III.A).
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/feature/features.hpp"
#include "posevote/model/view.hpp"

namespace posevote {

/// Where the object is in a picture: exactly one way is used, the first that is set of
/// mask, background, roi; none: the alpha channel if the picture has one that is not all opaque,
/// else the whole picture is the object.
struct ViewSource {
  cv::Mat picture;               ///< BGR, BGRA or grey, 8 or 16 bits
  cv::Mat background;            ///< the same scene without the object, same size
  cv::Mat mask;                  ///< same size, non-zero: object
  std::optional<cv::Rect> roi;   ///< px; must overlap the picture
  double yaw_deg = std::nan("");
};

struct SegmentOptions {
  // fields are the segmenter's own; see segment.hpp
  void describe(OptionList& list);
};

struct TeachOptions {
  FeatureOptions feature;
  int min_features = 8;  ///< a view with fewer is refused: it could never be recognised
  void describe(OptionList& list);
};

/// Makes the View: mask, outline, centre and the features inside the mask. Throws
/// Error{unusable_view} with advice when the mask is empty, touches the border all round, covers
/// nearly everything, or holds too few features; Error{invalid_argument} when sizes differ.
[[nodiscard]] View teach_view(const ViewSource& source, const TeachOptions& options = {});

}  // namespace posevote
