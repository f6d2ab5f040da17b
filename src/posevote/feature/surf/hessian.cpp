#include "posevote/feature/surf/hessian.hpp"

#include <array>
#include <cmath>
#include <opencv2/core/matx.hpp>

namespace posevote::surf {
namespace {

// One layer of an octave, sampled at every `step`-th pixel; 0 where the filter does not fit.
struct Layer {
  int size = 0;
  int width = 0, height = 0;
  std::vector<float> determinants;
  [[nodiscard]] float at(int y, int x) const {
    return determinants[static_cast<std::size_t>(y) * width + x];
  }
};

Layer compute_layer(const Integral& integral, int size, int step) {
  Layer layer{
      size, (integral.width() + step - 1) / step, (integral.height() + step - 1) / step, {}};
  layer.determinants.assign(static_cast<std::size_t>(layer.width) * layer.height, 0);
  const int border = size / 2;
  for (int j = 0; j < layer.height; ++j)
    for (int i = 0; i < layer.width; ++i) {
      const int x = i * step, y = j * step;
      if (x < border || y < border || x + border >= integral.width() ||
          y + border >= integral.height())
        continue;
      layer.determinants[static_cast<std::size_t>(j) * layer.width + i] =
          hessian_determinant(second_derivatives(integral, size, x, y), size);
    }
  return layer;
}

using Neighborhood = std::array<std::array<std::array<float, 3>, 3>, 3>;  // layer, y, x

bool is_maximum(const Neighborhood& n) {
  const float centre = n[1][1][1];
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        if ((k != 1 || j != 1 || i != 1) && n[k][j][i] >= centre) return false;
  return true;
}

// Offset of the maximum of the quadric through the 27 values, in samples (x, y, layer); Brown and
// Lowe 2002. False when it is not near the centre.
bool interpolate(const Neighborhood& n, cv::Vec3f& offset) {
  const float c2 = 2 * n[1][1][1];
  const float xx = n[1][1][2] + n[1][1][0] - c2;
  const float yy = n[1][2][1] + n[1][0][1] - c2;
  const float ss = n[2][1][1] + n[0][1][1] - c2;
  const float xy = (n[1][2][2] - n[1][2][0] - n[1][0][2] + n[1][0][0]) / 4;
  const float xs = (n[2][1][2] - n[2][1][0] - n[0][1][2] + n[0][1][0]) / 4;
  const float ys = (n[2][2][1] - n[2][0][1] - n[0][2][1] + n[0][0][1]) / 4;
  const cv::Matx33f hessian(xx, xy, xs, xy, yy, ys, xs, ys, ss);
  const cv::Vec3f gradient((n[1][1][2] - n[1][1][0]) / 2, (n[1][2][1] - n[1][0][1]) / 2,
                           (n[2][1][1] - n[0][1][1]) / 2);
  const cv::Vec3f solved = hessian.solve(-gradient, cv::DECOMP_LU);
  offset = solved;
  return std::abs(solved[0]) < 1 && std::abs(solved[1]) < 1 && std::abs(solved[2]) < 1 &&
         cv::norm(solved, cv::NORM_INF) > 0;
}

}  // namespace

SecondDerivatives second_derivatives(const Integral& integral, int size, int x, int y) {
  const int lobe = size / 3, half = size / 2, middle = lobe / 2;
  const auto box = [&](int x0, int y0, int x1, int y1) {  // closed ranges around (x, y)
    return static_cast<std::int32_t>(integral.box(x + x0, y + y0, x + x1 + 1, y + y1 + 1));
  };
  SecondDerivatives d{};
  d.xx = box(-half, 1 - lobe, half, lobe - 1) - 3 * box(-middle, 1 - lobe, middle, lobe - 1);
  d.yy = box(1 - lobe, -half, lobe - 1, half) - 3 * box(1 - lobe, -middle, lobe - 1, middle);
  d.xy = box(-lobe, -lobe, -1, -1) + box(1, 1, lobe, lobe) - box(1, -lobe, lobe, -1) -
         box(-lobe, 1, -1, lobe);
  return d;
}

float hessian_determinant(const SecondDerivatives& derivatives, int size) {
  // OpenCV divides by the area of a lobe (15 pixels at size 9), Bay et al. by that of the filter.
  const float norm = 81.0F / 15 / static_cast<float>(size * size);
  const float xx = static_cast<float>(derivatives.xx) * norm;
  const float yy = static_cast<float>(derivatives.yy) * norm;
  const float xy = static_cast<float>(derivatives.xy) * norm;
  return xx * yy - 0.81F * xy * xy;
}

std::vector<Keypoint> find_blobs(const Integral& integral, const SurfOptions& options) {
  std::vector<Keypoint> blobs;
  for (int octave = 0; octave < options.octaves; ++octave) {
    const int step = 1 << octave;
    std::vector<Layer> layers;
    for (int k = 0; k < options.layers + 2; ++k)
      layers.push_back(compute_layer(integral, filter_size(octave, k), step));
    for (int k = 1; k <= options.layers; ++k) {
      const int border = layers[k + 1].size / 2 / step + 1;
      for (int j = border; j + border < layers[k].height; ++j)
        for (int i = border; i + border < layers[k].width; ++i) {
          if (layers[k].at(j, i) < options.hessian_threshold) continue;
          Neighborhood n;
          for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
              for (int c = 0; c < 3; ++c) n[a][b][c] = layers[k + a - 1].at(j + b - 1, i + c - 1);
          cv::Vec3f offset;
          if (!is_maximum(n) || !interpolate(n, offset)) continue;
          Keypoint blob;
          blob.x = (static_cast<float>(i) + offset[0]) * static_cast<float>(step);
          blob.y = (static_cast<float>(j) + offset[1]) * static_cast<float>(step);
          blob.scale = scale_of_filter(static_cast<float>(layers[k].size) +
                                       offset[2] * static_cast<float>(6 * step));
          blob.response = n[1][1][1];
          const auto d = second_derivatives(integral, layers[k].size, i * step, j * step);
          blob.laplacian = d.xx + d.yy > 0 ? 1 : -1;
          blobs.push_back(blob);
        }
    }
  }
  return blobs;
}

}  // namespace posevote::surf
