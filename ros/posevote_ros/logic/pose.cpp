#include "logic/pose.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"

namespace posevote::logic {
namespace {

constexpr double decisive = 9.2;        // chi^2, 2 degrees of freedom, 99 %
constexpr double least_noise_px = 0.5;  // of a matched point
constexpr std::size_t most_witnesses = 12;

struct Fit {
  Pose pose;
  cv::Vec3d rotation_vector;
  double squared_error = 0;  ///< mean, px^2
};

cv::Matx33d turn_about_vertical(double yaw_deg) {
  const double a = yaw_deg * CV_PI / 180;
  return {std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a)};
}

cv::Matx33d look_down(double tilt_deg) {
  const double a = tilt_deg * CV_PI / 180;
  return {1, 0, 0, 0, std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a)};
}

/// The view shows the object turned and from above; the object's own frame is upright, its front
/// towards the viewer.
cv::Matx33d rotation_of_view(const View& view, const Relief& relief) {
  const double yaw_deg = std::isnan(view.yaw_deg) ? 0 : view.yaw_deg;
  return look_down(relief.known ? relief.tilt_deg : 0) * turn_about_vertical(-yaw_deg);
}

struct Points {
  std::vector<cv::Point2d> view, scene;  ///< px
};

/// Matched points, or for a detection without enough of them (none given) corners of its box.
Points collect_points(const Detection& detection, const cv::Rect2d& box) {
  Points points;
  for (const MatchedPoint& match : detection.matches) {
    points.view.push_back(match.view);
    points.scene.push_back(match.scene);
  }
  if (points.view.size() >= 4) return points;
  points.view = {box.tl(), {box.x + box.width, box.y}, box.br(), {box.x, box.y + box.height}};
  cv::perspectiveTransform(points.view, points.scene, detection.scene_from_view);
  return points;
}

/// Such points do not say how the plane is turned about their line.
bool are_on_a_line(const std::vector<cv::Point2d>& points) {
  const cv::Mat data = cv::Mat(points).reshape(1);
  const cv::PCA spread(data, cv::noArray(), cv::PCA::DATA_AS_ROW);
  const double across = spread.eigenvalues.at<double>(1), along = spread.eigenvalues.at<double>(0);
  return across <= 1e-4 * along;  // variances: a hundredth as wide as long
}

double mean_squared_error(const std::vector<cv::Point3d>& surface,
                          const std::vector<cv::Point2d>& seen, const cv::Mat& rvec,
                          const cv::Mat& tvec, const cv::Matx33d& matrix) {
  std::vector<cv::Point2d> projected;
  cv::projectPoints(surface, rvec, tvec, matrix, cv::noArray(), projected);
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const cv::Point2d d = projected[i] - seen[i];
    sum += d.dot(d);
  }
  return sum / static_cast<double>(seen.size());
}

/// What both poses of the plane that is nearest to the surface lead to, the better one first.
std::vector<Fit> fit_surface(const std::vector<cv::Point3d>& surface,
                             const std::vector<cv::Point2d>& seen, const cv::Matx33d& matrix) {
  std::vector<cv::Point3d> plane = surface;
  for (cv::Point3d& point : plane) point.z = 0;
  std::vector<cv::Mat> rvecs, tvecs;
  try {
    cv::solvePnPGeneric(plane, seen, matrix, cv::noArray(), rvecs, tvecs, false, cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {
    return {};  // points on one line
  }
  std::vector<Fit> fits;
  for (std::size_t i = 0; i < rvecs.size(); ++i) {
    cv::Mat rvec = rvecs[i].clone(), tvec = tvecs[i].clone();
    cv::solvePnPRefineLM(surface, seen, matrix, cv::noArray(), rvec, tvec);
    Fit fit;
    fit.rotation_vector = cv::Vec3d(rvec);
    cv::Rodrigues(fit.rotation_vector, fit.pose.rotation);
    fit.pose.translation = cv::Vec3d(tvec);
    fit.squared_error = mean_squared_error(surface, seen, rvec, tvec, matrix);
    if (std::isfinite(fit.squared_error) && fit.pose.translation[2] > 0) fits.push_back(fit);
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const Fit& a, const Fit& b) { return a.squared_error < b.squared_error; });
  return fits;
}

bool is_undecided(const Fit& better, const Fit& other, std::size_t points) {
  const double noise = std::max(better.squared_error, least_noise_px * least_noise_px);
  const double evidence = static_cast<double>(std::min(points, most_witnesses)) *
                          (other.squared_error - better.squared_error) / noise;
  // Both fits may have ended in one place.
  const cv::Matx33d turn = other.pose.rotation * better.pose.rotation.t();
  const double cosine = (cv::trace(turn) - 1) / 2;
  return evidence < decisive && cosine < std::cos(2 * CV_PI / 180);
}

}  // namespace

Camera crop_camera(const Camera& camera, const cv::Rect& roi) {
  Camera cropped = camera;
  cropped.size = roi.size();
  for (cv::Matx33d* matrix : {&cropped.matrix, &cropped.rectified_matrix}) {
    (*matrix)(0, 2) -= roi.x;
    (*matrix)(1, 2) -= roi.y;
  }
  return cropped;
}

Camera rectify_camera(const Camera& camera) {
  Camera rectified = camera;
  rectified.distortion.clear();
  if (camera.rectified_matrix(0, 0) > 0) rectified.matrix = camera.rectified_matrix;
  return rectified;
}

Camera scale_camera(const Camera& camera, cv::Size size) {
  if (camera.size == size || camera.size.empty() || size.empty()) return camera;
  Camera scaled = camera;
  scaled.size = size;
  const double sx = static_cast<double>(size.width) / camera.size.width;
  const double sy = static_cast<double>(size.height) / camera.size.height;
  const cv::Matx33d scale(sx, 0, (sx - 1) / 2, 0, sy, (sy - 1) / 2, 0, 0, 1);
  scaled.matrix = scale * camera.matrix;
  scaled.rectified_matrix = scale * camera.rectified_matrix;
  return scaled;
}

std::vector<cv::Point2d> undistort(const Camera& camera, const std::vector<cv::Point2d>& points) {
  const bool none = std::all_of(camera.distortion.begin(), camera.distortion.end(),
                                [](double coefficient) { return coefficient == 0; });
  if (none || points.empty()) return points;
  std::vector<cv::Point2d> ideal;
  if (camera.distortion_model == "equidistant" && camera.distortion.size() == 4)
    cv::fisheye::undistortPoints(points, ideal, camera.matrix, camera.distortion, cv::noArray(),
                                 camera.matrix);
  else if ((camera.distortion_model == "plumb_bob" && camera.distortion.size() == 5) ||
           (camera.distortion_model == "rational_polynomial" && camera.distortion.size() == 8))
    cv::undistortPoints(points, ideal, camera.matrix, camera.distortion, cv::noArray(),
                        camera.matrix);
  else
    throw Error(ErrorCode::unsupported,
                "distortion model '" + camera.distortion_model + "' with " +
                    std::to_string(camera.distortion.size()) +
                    " coefficients is not known; give rectified pictures, or one of plumb_bob (5), "
                    "rational_polynomial (8), equidistant (4)");
  return ideal;
}

cv::Vec4d quaternion(const cv::Matx33d& rotation) {
  cv::Vec3d axis;
  cv::Rodrigues(rotation, axis);
  const double angle = cv::norm(axis);
  if (angle < 1e-12) return {0, 0, 0, 1};
  const cv::Vec3d half = axis * (std::sin(angle / 2) / angle);
  return {half[0], half[1], half[2], std::cos(angle / 2)};  // angle <= pi
}

std::optional<ObjectPose> find_pose(const Detection& detection, const View& view, double height_m,
                                    const Camera& camera, const Relief& relief) {
  const cv::Rect2d box = cv::boundingRect(view.outline);
  if (box.height <= 0 || !(height_m > 0) || !camera.is_calibrated()) return std::nullopt;
  const double metres_per_px = height_m / box.height;
  const cv::Point2d origin = view.centre;
  const auto at_depth = [&](cv::Point2d p, double depth_px) {
    return cv::Point3d(p.x - origin.x, p.y - origin.y, depth_px) * metres_per_px;
  };
  const Points points = collect_points(detection, box);
  if (are_on_a_line(points.view) || are_on_a_line(points.scene)) return std::nullopt;
  std::vector<cv::Point3d> surface;
  for (const cv::Point2d& p : points.view)
    surface.push_back(at_depth(p, relief.known ? relief.depth_px(p) : 0));
  const auto fits = fit_surface(surface, undistort(camera, points.scene), camera.matrix);
  if (fits.empty()) return std::nullopt;

  const cv::Matx33d view_from_object = rotation_of_view(view, relief);
  ObjectPose found;
  found.pose = {fits[0].pose.rotation * view_from_object, fits[0].pose.translation};
  found.view_pose = fits[0].pose;
  found.flat = !relief.known;
  found.size_m = {box.width * metres_per_px, height_m};
  found.error_px = std::sqrt(fits[0].squared_error);
  if (fits.size() > 1 && is_undecided(fits[0], fits[1], surface.size()))
    found.other = Pose{fits[1].pose.rotation * view_from_object, fits[1].pose.translation};
  for (const cv::Point2f& p : view.outline)
    found.outline.push_back(fits[0].pose.rotation * cv::Vec3d(at_depth(p, 0)) +
                            fits[0].pose.translation);
  return found;
}

std::vector<cv::Vec3d> outline_at(const std::vector<cv::Point2f>& outline_px, const Camera& camera,
                                  double distance_m) {
  const std::vector<cv::Point2d> points(outline_px.begin(), outline_px.end());
  std::vector<cv::Vec3d> outline;
  const cv::Matx33d rays = camera.matrix.inv();
  for (const cv::Point2d& p : undistort(camera, points)) {
    const cv::Vec3d ray = rays * cv::Vec3d(p.x, p.y, 1);
    outline.push_back(ray * (distance_m / ray[2]));
  }
  return outline;
}

LabelPlace place_label(const std::vector<cv::Vec3d>& outline) {
  LabelPlace place;
  if (outline.empty()) return place;
  double top = outline[0][1];
  for (const cv::Vec3d& p : outline) {
    place.position += p * (1.0 / static_cast<double>(outline.size()));
    top = std::min(top, p[1]);
  }
  // Sizes that look alike at any distance: about 1/40 of what a common lens shows.
  place.letter_height_m = place.position[2] / 40;
  place.line_width_m = place.position[2] / 400;
  place.position[1] = top - place.letter_height_m;
  return place;
}

std::map<std::string, double> parse_heights(const std::string& text) {
  const auto trimmed = [](const std::string& s) {
    const std::size_t first = s.find_first_not_of(" \t\n"), last = s.find_last_not_of(" \t\n");
    return first == std::string::npos ? std::string() : s.substr(first, last - first + 1);
  };
  std::map<std::string, double> heights;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    const std::string entry = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (entry.empty()) continue;
    const std::size_t equals = entry.rfind('=');
    const std::string name =
        equals == std::string::npos ? std::string() : trimmed(entry.substr(0, equals));
    double height = 0;
    std::size_t used = 0;
    const std::string number =
        equals == std::string::npos ? std::string() : trimmed(entry.substr(equals + 1));
    try {
      height = std::stod(number, &used);
    } catch (const std::exception&) {
    }
    if (name.empty() || used != number.size() || !(height > 0) || !std::isfinite(height))
      throw Error(ErrorCode::invalid_argument,
                  "'" + entry + "' is not NAME=HEIGHT with a height in metres, e.g. mug=0.095");
    heights[name] = height;
  }
  return heights;
}

}  // namespace posevote::logic
