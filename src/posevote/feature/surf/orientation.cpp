#include "posevote/feature/surf/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace posevote::surf {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kSector = kPi / 3;

struct Response {
  float dx, dy, angle;
};

}  // namespace

float orientation(const Integral& integral, const Keypoint& keypoint) {
  const int step = std::max(1, static_cast<int>(std::lround(keypoint.scale)));
  const int cx = static_cast<int>(std::lround(keypoint.x));
  const int cy = static_cast<int>(std::lround(keypoint.y));
  std::vector<Response> responses;
  for (int j = -5; j <= 5; ++j)
    for (int i = -5; i <= 5; ++i) {
      if (i * i + j * j >= 36) continue;
      const int x = cx + i * step, y = cy + j * step, half = 2 * step;
      if (x < half || y < half || x + half > integral.width() || y + half > integral.height())
        continue;
      const float weight = std::exp(-static_cast<float>(i * i + j * j) / (2 * 2.0F * 2.0F));
      const auto box = [&](int x0, int y0, int x1, int y1) {
        return static_cast<float>(integral.box(x + x0, y + y0, x + x1, y + y1));
      };
      const float dx = weight * (box(0, -half, half, half) - box(-half, -half, 0, half));
      const float dy = weight * (box(-half, 0, half, half) - box(-half, -half, half, 0));
      responses.push_back({dx, dy, std::atan2(dy, dx)});
    }
  std::ranges::sort(responses, {}, &Response::angle);

  float best = 0, best_x = 1, best_y = 0;
  for (std::size_t first = 0; first < responses.size(); ++first) {
    float x = 0, y = 0;
    for (std::size_t k = 0; k < responses.size(); ++k) {
      const Response& r = responses[(first + k) % responses.size()];
      float turn = r.angle - responses[first].angle;
      if (turn < 0) turn += 2 * kPi;
      if (turn >= kSector) break;
      x += r.dx;
      y += r.dy;
    }
    if (x * x + y * y > best) {
      best = x * x + y * y;
      best_x = x;
      best_y = y;
    }
  }
  const float angle = std::atan2(best_y, best_x);
  return angle < kPi ? angle : -kPi;
}

}  // namespace posevote::surf
