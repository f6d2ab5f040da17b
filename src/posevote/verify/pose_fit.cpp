#include "posevote/verify/pose_fit.hpp"

#include <cmath>

namespace posevote {
namespace {

using Vector8 = cv::Vec<double, 8>;
using Matrix8 = cv::Matx<double, 8, 8>;

// Parameters: a, b (similarity), e, f (stretch), tx, ty, g, h (perspective), in the view's frame:
//   x (1 + g u + h v) = (a + e) u + (f - b) v + tx
//   y (1 + g u + h v) = (f + b) u + (a - e) v + ty
struct Equation {
  Vector8 row;
  double right;
};

void accumulate(const Equation& equation, double weight, Matrix8& normal, Vector8& right) {
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) normal(i, j) += weight * equation.row[i] * equation.row[j];
    right[i] += weight * equation.row[i] * equation.right;
  }
}

/// Ridge terms: stretch against the scale of the last round, perspective against 1.
void add_priors(const Vector8& last, const PoseFitOptions& options, Matrix8& normal) {
  const double scale = std::max(1e-3, std::hypot(last[0], last[1]));
  const double stretch = 1 / std::pow(options.stretch_prior * scale, 2);
  const double perspective = 1 / std::pow(options.perspective_prior, 2);
  normal(2, 2) += stretch;
  normal(3, 3) += stretch;
  normal(6, 6) += perspective;
  normal(7, 7) += perspective;
}

/// Back from the frame to pixels of the view.
cv::Matx33d to_pixels(const Vector8& p, const ViewFrame& frame) {
  const cv::Matx33d in_frame(p[0] + p[2], p[3] - p[1], p[4], p[3] + p[1], p[0] - p[2], p[5], p[6],
                             p[7], 1);
  const double s = 1 / frame.half_size;
  const cv::Matx33d frame_from_view(s, 0, -s * frame.centre.x, 0, s, -s * frame.centre.y, 0, 0, 1);
  const cv::Matx33d result = in_frame * frame_from_view;
  return result(2, 2) > 1e-12 ? result * (1 / result(2, 2)) : cv::Matx33d::zeros();
}

Vector8 start_from_similarity(const std::vector<PointPair>& pairs, const ViewFrame& frame) {
  const cv::Matx33d similarity = fit_transform(TransformKind::similarity, pairs);
  const cv::Point2f centre = transform_point(similarity, frame.centre);
  return {similarity(0, 0) * frame.half_size,
          similarity(1, 0) * frame.half_size,
          0,
          0,
          centre.x,
          centre.y,
          0,
          0};
}

}  // namespace

void PoseFitOptions::describe(OptionList& list) {
  list.add("stretch_prior", stretch_prior, {1e-6, 10}, "",
           "Expected departure from a similarity: stretch and shear, standard deviation.");
  list.add("perspective_prior", perspective_prior, {1e-6, 10}, "",
           "Expected change of scale from the centre to the rim, standard deviation.");
}

cv::Matx33d fit_pose(const std::vector<PointPair>& pairs, const ViewFrame& frame, double noise_px,
                     const PoseFitOptions& options) {
  if (cv::norm(cv::Mat(fit_transform(TransformKind::similarity, pairs))) == 0)
    return cv::Matx33d::zeros();
  Vector8 p = start_from_similarity(pairs, frame);
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    Matrix8 normal = Matrix8::zeros();
    Vector8 right = Vector8::all(0);
    add_priors(p, options, normal);
    for (const auto& pair : pairs) {
      const double u = (pair.view.x - frame.centre.x) / frame.half_size;
      const double v = (pair.view.y - frame.centre.y) / frame.half_size;
      const double x = pair.scene.x, y = pair.scene.y;
      const double w = 1 + p[6] * u + p[7] * v;
      if (!(w > 0.1)) return cv::Matx33d::zeros();
      const double weight = 1 / (w * w * noise_px * noise_px);
      accumulate({{u, -v, u, v, 1, 0, -x * u, -x * v}, x}, weight, normal, right);
      accumulate({{v, u, -v, u, 0, 1, -y * u, -y * v}, y}, weight, normal, right);
    }
    if (!cv::solve(normal, right, p, cv::DECOMP_CHOLESKY)) return cv::Matx33d::zeros();
  }
  return to_pixels(p, frame);
}

}  // namespace posevote
