// From a recognised view to a pose in space.
#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "logic/relief.hpp"
#include "posevote/model/view.hpp"
#include "posevote/recognize/recognizer.hpp"

namespace posevote::logic {

/// sensor_msgs/CameraInfo without ROS: what a camera's calibration says.
struct Camera {
  cv::Size size;                 ///< px of the pictures it was calibrated with
  cv::Matx33d matrix;            ///< K, px
  cv::Matx33d rectified_matrix;  ///< left part of P, px: for rectified pictures
  std::string distortion_model;  ///< "plumb_bob", "rational_polynomial", "equidistant"; "": none
  std::vector<double> distortion;

  /// False for a camera_info that was never filled in (K of zeros).
  [[nodiscard]] bool is_calibrated() const { return matrix(0, 0) > 0 && matrix(1, 1) > 0; }
};

/// The camera for pictures that show only `roi` of its own.
[[nodiscard]] Camera crop_camera(const Camera& camera, const cv::Rect& roi);

/// The camera for pictures without distortion.
[[nodiscard]] Camera rectify_camera(const Camera& camera);

/// The camera for pictures of another size: matrices scaled along, for drivers that bin pixels.
/// Pixel (0, 0) is the centre of the top-left pixel.
[[nodiscard]] Camera scale_camera(const Camera& camera, cv::Size size);

/// Where `points` (px) would be without distortion, px of the same K. Throws Error{unsupported} for
/// a distortion model that is not known.
[[nodiscard]] std::vector<cv::Point2d> undistort(const Camera& camera,
                                                 const std::vector<cv::Point2d>& points);

/// Frame of an object: origin on the surface in the middle of the view's silhouette, x right, y
/// down its upright axis, z away from who looks at its front (the view of yaw 0, or of unknown
/// yaw). Metres.
struct Pose {
  cv::Matx33d rotation = cv::Matx33d::eye();  ///< object -> camera's optical frame
  cv::Vec3d translation;
};

/// The quaternion (x, y, z, w), w >= 0, of a rotation matrix.
[[nodiscard]] cv::Vec4d quaternion(const cv::Matx33d& rotation);

struct ObjectPose {
  Pose pose;
  Pose view_pose;             ///< of the view's picture plane: the same without its yaw and tilt
  bool flat = true;           ///< the view was taken for a plane: its relief is not known
  cv::Size2d size_m;          ///< of the silhouette's box in that plane
  double error_px = 0;        ///< root of the mean squared distance of the reprojected points
  std::optional<Pose> other;  ///< the mirrored pose, when the picture does not decide between them
  std::vector<cv::Vec3d> outline;  ///< the view's silhouette, metres, camera's optical frame
};

/// The pose of `detection`, an instance of `view`, whose silhouette is `height_m` high and whose
/// surface has that `relief`; without one it is taken for a plane that faced the camera. It is the
/// pose whose projection fits the matched points best: least squares from both poses of the plane
/// (infinitesimal plane-based pose estimation: Collins & Bartoli, IJCV 109(3), 2014). What is seen
/// from far away looks nearly the same mirrored; with n points and noise s the two are told apart
/// when n (e2^2 - e1^2) / s^2 > 9.2, the 99 % point of chi^2 with two degrees of freedom (its two
/// angles); s is the fit's own error, at least half a pixel. Where the surface is not as smooth as
/// the relief, the points do not err independently: no more than 12 are counted. Empty when the
/// points lie on a line, the fit fails, or the object would be behind the camera.
[[nodiscard]] std::optional<ObjectPose> find_pose(const Detection& detection, const View& view,
                                                  double height_m, const Camera& camera,
                                                  const Relief& relief = {});

/// The silhouette on the viewing rays at `distance_m` (z of the optical frame), metres: something
/// to show when the object's height is not known.
[[nodiscard]] std::vector<cv::Vec3d> outline_at(const std::vector<cv::Point2f>& outline_px,
                                                const Camera& camera, double distance_m);

/// Where to write the name of an object with this outline (see `outline_at`), and how large.
struct LabelPlace {
  cv::Vec3d position;
  double letter_height_m = 0, line_width_m = 0;
};
[[nodiscard]] LabelPlace place_label(const std::vector<cv::Vec3d>& outline);

/// "mug=0.095; blue mug=0.1" -> metres by name. Throws Error{invalid_argument} when it is not that,
/// or a height is not a positive number.
[[nodiscard]] std::map<std::string, double> parse_heights(const std::string& text);

}  // namespace posevote::logic
