// For tests: a can with features all round, as a camera far away sees it.
#pragma once

#include <cmath>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/model/view.hpp"

namespace posevote::logic {

struct MadeCan {
  static constexpr double radius = 60, height = 160;  ///< px of a view of scale 1
  static constexpr int features = 300;

  struct Mark {
    double angle, y;
    std::vector<float> descriptor;
  };
  std::vector<Mark> marks;

  MadeCan() {
    cv::RNG random(5);
    for (int i = 0; i < features; ++i) {
      Mark mark{random.uniform(0.0, 2 * CV_PI), random.uniform(-height / 2, height / 2), {}};
      cv::Mat_<float> values(1, 64);
      random.fill(values, cv::RNG::NORMAL, 0, 1);
      values *= 1 / cv::norm(values);
      mark.descriptor.assign(values.begin(), values.end());
      marks.push_back(mark);
    }
  }

  /// In the can's upright frame: x right, y down, z away; yaw 0 looks at angle 0.
  [[nodiscard]] static cv::Vec3d place(const Mark& mark) {
    return {radius * std::sin(mark.angle), mark.y, -radius * std::cos(mark.angle)};
  }

  /// Rotation from the can's frame to that of a camera that looks down by `tilt_deg` on the can
  /// turned by `yaw_deg`, anticlockwise as seen from above.
  [[nodiscard]] static cv::Matx33d rotation(double yaw_deg, double tilt_deg) {
    const double a = yaw_deg * CV_PI / 180, t = tilt_deg * CV_PI / 180;
    const cv::Matx33d turn(std::cos(a), 0, -std::sin(a), 0, 1, 0, std::sin(a), 0, std::cos(a));
    const cv::Matx33d tilt(1, 0, 0, 0, std::cos(t), -std::sin(t), 0, std::sin(t), std::cos(t));
    return tilt * turn;
  }

  [[nodiscard]] static bool is_seen(const Mark& mark, const cv::Matx33d& rotation) {
    const cv::Vec3d outwards(std::sin(mark.angle), 0, -std::cos(mark.angle));
    return (rotation * outwards)[2] < -0.2;
  }

  [[nodiscard]] std::shared_ptr<View> view(double yaw_deg, double tilt_deg, double scale = 1,
                                           cv::Point2d centre = {200, 200}) const {
    auto made = std::make_shared<View>();
    made->id = made->hash = std::to_string(yaw_deg);
    made->yaw_deg = yaw_deg;
    made->centre = centre;
    const auto rx = static_cast<float>(radius * scale), ry = static_cast<float>(height / 2 * scale);
    const cv::Point2f c = centre;
    made->outline = {
        {c.x - rx, c.y - ry}, {c.x + rx, c.y - ry}, {c.x + rx, c.y + ry}, {c.x - rx, c.y + ry}};
    const cv::Matx33d turned = rotation(yaw_deg, tilt_deg);
    for (const Mark& mark : marks) {
      if (!is_seen(mark, turned)) continue;
      const cv::Vec3d p = turned * place(mark) * scale;
      Keypoint point;
      point.x = static_cast<float>(centre.x + p[0]);
      point.y = static_cast<float>(centre.y + p[1]);
      made->features.keypoints.push_back(point);
      made->features.descriptors.push_back(cv::Mat(mark.descriptor, true).reshape(1, 1));
    }
    return made;
  }
};

}  // namespace posevote::logic
