// From a picture of an object to a taught View (paper, III.A).
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/feature/features.hpp"
#include "posevote/model/view.hpp"
#include "posevote/teach/segment.hpp"

namespace posevote {

/// Where the object is in a picture: exactly one way is used, the first that is set of
/// mask, background, roi; none: the alpha channel if the picture has one that is not all opaque,
/// else the whole picture is the object.
struct ViewSource {
  cv::Mat picture;              ///< BGR, BGRA or grey, 8 or 16 bits
  cv::Mat background;           ///< the same scene without the object, same size
  cv::Mat mask;                 ///< same size, any such type; brighter than half: object
  std::optional<cv::Rect> roi;  ///< px; must overlap the picture
  double yaw_deg = std::nan("");
};

struct TeachOptions {
  FeatureOptions feature;
  SegmentOptions segment;
  int min_features = 8;  ///< a view with fewer is refused: it could never be recognised
  /// Features nearer to the silhouette than this many times their scale are left out. A descriptor
  /// reaches about 10 scales (SURF) or 8.5 (SIFT) far: 0 keeps those that see the background too,
  /// which are many on small objects; 10 keeps only what is the object's own.
  double border_scales = 0;
  /// Paint the surroundings in the object's mean colour before features are extracted, so that
  /// descriptors at the silhouette hold no texture of the background that was taught on. Changes
  /// the silhouette's own contrast.
  bool paint_surroundings = false;
  /// Keep only features that repeat, see find_repeatable: the others make the database larger and
  /// hardly ever match.
  bool only_repeatable = true;
  /// Also keep the features of the picture shortened upright: from 45 degrees above or below,
  /// where no view is taught, the object looks like that.
  bool foreshortened = true;
  void describe(OptionList& list);
};

/// The object's pixels: CV_8U, 0 or 255, size of the picture. Throws as `teach_view` does.
[[nodiscard]] cv::Mat find_object(const ViewSource& source, const SegmentOptions& options = {});

/// Makes the View: mask, outline, centre, the features inside the mask and a BGR 8-bit copy of the
/// picture; id and hash stay empty. Deterministic and safe to call from many threads. Throws
/// Error{unusable_view} with advice when no object is found, the mask is empty, a background
/// difference touches all four sides or covers nearly everything, the camera has moved in between,
/// or there are too few features; Error{invalid_argument} when sizes differ or a type is not
/// allowed.
[[nodiscard]] View teach_view(const ViewSource& source, const TeachOptions& options = {});

}  // namespace posevote
