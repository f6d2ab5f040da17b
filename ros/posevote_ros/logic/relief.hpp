// How the surface of a taught object lies in depth, from its neighbouring views.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/model/view.hpp"

namespace posevote::logic {

/// The surface that a view shows, as a smooth one: a polynomial of second order over the picture.
struct Relief {
  bool known = false;        ///< false: no neighbour told it; the view is taken for a plane
  double tilt_deg = 0;       ///< how far the camera looked down on the object
  cv::Point2d centre;        ///< of the view, px
  double size_px = 1;        ///< half of the silhouette's larger side
  cv::Vec<double, 5> shape;  ///< coefficients of x, y, x^2, xy, y^2 in units of size_px

  /// Away from the viewer, px of the view; 0 at `centre`.
  [[nodiscard]] double depth_px(cv::Point2d point) const;
};

/// The relief of `view`, one of `views`, from those of known yaw that differ from it by 5 to 60
/// degrees. Features that two views have in common move as a turn about the upright axis says:
/// with scaled orthographic cameras and a known angle each pair gives its depth, and the lines that
/// they move along give the tilt (Koenderink & van Doorn, JOSA A 8(2), 1991). Distance and place
/// of the object may differ from view to view, the camera's roll may not. Deterministic. Not known
/// when yaws are not, too few features agree, or the surface would be hollow from side to side:
/// then the yaws have the wrong sign.
[[nodiscard]] Relief find_relief(const View& view,
                                 const std::vector<std::shared_ptr<const View>>& views);

/// Reliefs, each found when first asked for and again when the object's views have changed. Safe to
/// use from many threads.
class ReliefCache {
 public:
  [[nodiscard]] Relief find(const ObjectModel& object, const View& view);

 private:
  struct Known {
    std::vector<std::string> hashes;  ///< of all views of the object
    std::map<std::string, Relief> reliefs;
  };
  std::mutex mutex_;
  std::map<std::string, Known> known_;
};

}  // namespace posevote::logic
