// What is known of an object: its taught views.
#pragma once

#include <cmath>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/feature/features.hpp"
#include "posevote/model/patch.hpp"

namespace posevote {

/// One taught picture of an object. Coordinates are pixels of that picture.
struct View {
  std::string id;                 ///< unique within the object, e.g. "3"; given by the store
  std::string hash;               ///< content hash, equal for equal content; "" when made in memory
  double yaw_deg = std::nan("");  ///< turn about the vertical axis; NaN: unknown
  cv::Size image_size;
  std::vector<cv::Point2f> outline;  ///< the silhouette, a simple polygon of >= 3 points
  cv::Point2f centre;                ///< centroid of the mask: c_o of Eq. 1
  Features features;                 ///< inside the mask only; of a loaded view CV_16F
  Patch patch;                       ///< the object in small; may be empty
  cv::Mat picture;  ///< BGR 8-bit, the taught picture, for showing it; may be empty
  cv::Mat mask;     ///< CV_8U 0/255, size of the picture; may be empty
};

/// An object by name with its views.
struct ObjectModel {
  std::string name;
  std::vector<std::shared_ptr<const View>> views;
};

}  // namespace posevote
