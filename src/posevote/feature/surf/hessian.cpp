#include "posevote/feature/surf/hessian.hpp"

#include <algorithm>
#include <cmath>

namespace posevote::surf {
namespace {

constexpr float kOutside = -1e30F;  // never a maximum, never keeps another from being one

// Solves the symmetric 3 x 3 system by Cramer's rule; false when it is singular.
bool solve(float xx, float yy, float ss, float xy, float xs, float ys, const float b[3],
           float out[3]) {
  const float cxx = yy * ss - ys * ys, cxy = xs * ys - xy * ss, cxs = xy * ys - xs * yy;
  const float determinant = xx * cxx + xy * cxy + xs * cxs;
  if (determinant == 0) return false;
  const float cyy = xx * ss - xs * xs, cys = xy * xs - xx * ys, css = xx * yy - xy * xy;
  out[0] = (cxx * b[0] + cxy * b[1] + cxs * b[2]) / determinant;
  out[1] = (cxy * b[0] + cyy * b[1] + cys * b[2]) / determinant;
  out[2] = (cxs * b[0] + cys * b[1] + css * b[2]) / determinant;
  return std::isfinite(out[0]) && std::isfinite(out[1]) && std::isfinite(out[2]);
}

}  // namespace

void BlobSearch::prepare(const Integral& integral, const SurfOptions& options, int team_size) {
  integral_ = &integral;
  options_ = options;
  width_ = integral.width() - 2 * kMargin;
  height_ = integral.height() - 2 * kMargin;
  ring_stride_ = (width_ / 16 | 1) * 16 + 32;  // no two rows share their cache sets
  prepare_kept();
  parts_.resize(team_size);
  for (Part& part : parts_) {
    part.ring.resize(static_cast<std::size_t>(options.layers + 2) * 3 * ring_stride_);
    part.full.resize(width_);
    part.columns.resize(width_);
    part.candidates.clear();
  }
}

void BlobSearch::prepare_kept() {
  kept_.resize(options_.octaves);
  const int layers = options_.layers + 2;
  for (int octave = 1; octave < options_.octaves; ++octave) {
    std::size_t used = 0;
    for (int a = 0; a < layers; ++a)
      for (int b = 0; b < layers; ++b) {
        if (filter_size(octave - 1, a) != filter_size(octave, b)) continue;
        if (kept_[octave].size() == used) kept_[octave].emplace_back();
        Kept& kept = kept_[octave][used++];
        kept.size = filter_size(octave, b);
        kept.stride = columns_of(octave);
        kept.values.resize(static_cast<std::size_t>(kept.stride) * rows_of(octave));
      }
    kept_[octave].resize(used);
  }
}

// Samples whose filter would reach past the margin.
int BlobSearch::border(int octave, int layer) const {
  const int missing = std::max(0, filter_size(octave, layer) / 2 - kMargin);
  return (missing + (1 << octave) - 1) >> octave;
}

float* BlobSearch::ring_row(Part& part, int layer, int j) const {
  return part.ring.data() + static_cast<std::ptrdiff_t>(layer * 3 + (j + 3) % 3) * ring_stride_;
}

void BlobSearch::fill_row(int octave, int layer, int j, Part& part, float* row) const {
  const int step = 1 << octave, count = columns_of(octave), size = filter_size(octave, layer);
  const auto known = std::ranges::find(kept_[octave], size, &Kept::size);
  if (known != kept_[octave].end()) {
    std::copy_n(&known->values[static_cast<std::size_t>(j) * known->stride], count, row);
    return;
  }
  const int missing = std::max(0, size / 2 - kMargin);
  const int first = border(octave, layer), y = j * step;
  const int last = (width_ - 1 - missing) >= 0 ? (width_ - 1 - missing) / step : -1;
  if (y < missing || y + missing >= height_ || last < first) {
    std::fill_n(row, count, kOutside);
    return;
  }
  std::fill_n(row, first, kOutside);
  std::fill(row + last + 1, row + count, kOutside);
  float* full = octave == 0 ? row + first : part.full.data();
  simd::hessian_row(integral_->view(), first * step + kMargin, y + kMargin,
                    (last - first) * step + 1, size / 3, hessian_norm(size), full);
  if (octave > 0)
    for (int i = first; i <= last; ++i) row[i] = full[(i - first) * step];
}

void BlobSearch::keep_row(int octave, int layer, int j, const float* row) {
  if (j % 2 || octave + 1 >= options_.octaves) return;
  auto& above = kept_[octave + 1];
  const auto next = std::ranges::find(above, filter_size(octave, layer), &Kept::size);
  if (next == above.end()) return;
  float* out = &next->values[static_cast<std::size_t>(j / 2) * next->stride];
  for (int i = 0; i < next->stride; ++i) out[i] = row[2 * i];
}

void BlobSearch::find_in_row(int octave, int j, Part& part) const {
  const int step = 1 << octave, count = columns_of(octave);
  const auto threshold = static_cast<float>(std::max(options_.hessian_threshold, 1e-6));
  for (int layer = 1; layer <= options_.layers; ++layer) {
    const float* rows[simd::kMaximaRows];
    for (int k = 0; k < 9; ++k) rows[k] = ring_row(part, layer - 1 + k / 3, j - 1 + k % 3);
    const int found = simd::find_maxima(rows, count, threshold, part.columns.data());
    for (int n = 0; n < found; ++n) {
      const int i = part.columns[n];
      Candidate candidate;
      candidate.octave = octave;
      candidate.layer = layer;
      candidate.x = i * step;
      candidate.y = j * step;
      bool whole = true;
      for (int k = 0; k < 9; ++k)
        for (int c = 0; c < 3; ++c) {
          candidate.around[k / 3][k % 3][c] = rows[k][i + c - 1];
          whole &= rows[k][i + c - 1] > kOutside;
        }
      if (whole) part.candidates.push_back(candidate);
    }
  }
}

void BlobSearch::search_octave(int octave, const Member& member, Part& part) {
  const int rows = rows_of(octave), layers = options_.layers + 2;
  const int begin = member.begin(rows), end = member.end(rows);
  if (begin == end) return;
  const int first = std::max(0, begin - 1), last = std::min(rows - 1, end);
  for (int j = first; j <= last; ++j) {
    for (int layer = 0; layer < layers; ++layer) {
      float* row = ring_row(part, layer, j);
      fill_row(octave, layer, j, part, row);
      if (j >= begin && j < end) keep_row(octave, layer, j, row);
    }
    if (j - 1 >= std::max(1, begin) && j - 1 < end) find_in_row(octave, j - 1, part);
  }
}

const std::vector<Candidate>& BlobSearch::search(const Member& member) {
  Part& part = parts_[member.index()];
  for (int octave = 0; octave < options_.octaves; ++octave) {
    search_octave(octave, member, part);
    member.wait();
  }
  return part.candidates;
}

bool refine(const Candidate& candidate, const Integral& integral, Keypoint& keypoint) {
  const auto& n = candidate.around;
  const float twice = 2 * n[1][1][1];
  const float xx = n[1][1][2] + n[1][1][0] - twice;
  const float yy = n[1][2][1] + n[1][0][1] - twice;
  const float ss = n[2][1][1] + n[0][1][1] - twice;
  const float xy = (n[1][2][2] - n[1][2][0] - n[1][0][2] + n[1][0][0]) / 4;
  const float xs = (n[2][1][2] - n[2][1][0] - n[0][1][2] + n[0][1][0]) / 4;
  const float ys = (n[2][2][1] - n[2][0][1] - n[0][2][1] + n[0][0][1]) / 4;
  const float gradient[3] = {(n[1][1][0] - n[1][1][2]) / 2, (n[1][0][1] - n[1][2][1]) / 2,
                             (n[0][1][1] - n[2][1][1]) / 2};
  float offset[3];
  if (!solve(xx, yy, ss, xy, xs, ys, gradient, offset)) return false;
  for (const float value : offset)
    if (std::abs(value) >= 1) return false;
  const int step = 1 << candidate.octave, size = filter_size(candidate.octave, candidate.layer);
  keypoint = {};
  keypoint.x = static_cast<float>(candidate.x) + offset[0] * static_cast<float>(step);
  keypoint.y = static_cast<float>(candidate.y) + offset[1] * static_cast<float>(step);
  keypoint.scale =
      scale_of_filter(static_cast<float>(size) + offset[2] * static_cast<float>(6 * step));
  keypoint.response = candidate.response();
  const int x = candidate.x + kMargin, y = candidate.y + kMargin;
  const int lobe = size / 3, half = size / 2, middle = lobe / 2;
  const auto box = [&](int x0, int y0, int x1, int y1) {
    return static_cast<std::int32_t>(integral.box(x + x0, y + y0, x + x1 + 1, y + y1 + 1));
  };
  const std::int32_t trace =
      box(-half, 1 - lobe, half, lobe - 1) - 3 * box(-middle, 1 - lobe, middle, lobe - 1) +
      box(1 - lobe, -half, lobe - 1, half) - 3 * box(1 - lobe, -middle, lobe - 1, middle);
  keypoint.laplacian = trace > 0 ? 1 : -1;
  return true;
}

}  // namespace posevote::surf
