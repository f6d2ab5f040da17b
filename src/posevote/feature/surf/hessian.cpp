#include "posevote/feature/surf/hessian.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace posevote::surf {
namespace {

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

// The samples of an octave in which peaks may lie, closed ranges: those of the picture whose
// filters, and those of their neighbours in all layers, lie in the level.
struct Range {
  int first, last;
  [[nodiscard]] int size() const { return last - first + 1; }
};
Range range_of(int length, int level_length, int octave, int layers) {
  const int largest = lobe_of(layers + 1), reach = largest + largest / 2 + 1;
  // Sample i lies at (i + 0.5) 2^octave - 0.5 - kMargin of the picture.
  const int step = 1 << octave;
  const int first = (2 * kMargin + 1 - step + 2 * step - 1) / (2 * step);
  const int last = (2 * (length + kMargin) - 1 - step) / (2 * step);
  return {std::max(first + 1, reach), std::min(last - 1, level_length - 1 - reach)};
}

Range columns_of(const Integral& integral, int octave, int layers) {
  return range_of(integral.width() - 2 * kMargin, integral.view(octave).width, octave, layers);
}
Range rows_of(const Integral& integral, int octave, int layers) {
  return range_of(integral.height() - 2 * kMargin, integral.view(octave).height, octave, layers);
}

}  // namespace

// Two rows more than a block has are filtered: blocks are low only where threads share the work.
void BlobSearch::cut_into_blocks(int threads) {
  constexpr int kLeastRows = 48;
  blocks_used_ = 0;
  for (int octave = 0; octave < options_.octaves; ++octave) {
    const Range rows = rows_of(*integral_, octave, options_.layers);
    const int total = rows.last - rows.first + 1;
    if (total < 1 || columns_of(*integral_, octave, options_.layers).size() < 1) continue;
    const int count = threads > 1 ? std::clamp(total / kLeastRows, 1, 4 * threads) : 1;
    for (int layer = 1; layer <= options_.layers; layer += 2)
      for (int k = 0; k < count; ++k) {
        if (blocks_used_ == static_cast<int>(blocks_.size())) blocks_.emplace_back();
        Block& block = blocks_[blocks_used_++];
        block.octave = octave;
        block.layer = layer;
        block.begin = rows.first + total * k / count;
        block.end = rows.first + total * (k + 1) / count;
        block.peaks.clear();
      }
  }
  by_place_.resize(blocks_used_);
  std::iota(by_place_.begin(), by_place_.end(), 0);
  std::ranges::sort(by_place_, {}, [&](int b) {  // std::stable_sort would allocate
    const Block& block = blocks_[b];
    return std::pair((block.begin + block.end) << block.octave, b);
  });
}

void BlobSearch::search_block(Block& block, Buffers& buffers) const {
  const int octave = block.octave, layer = block.layer;
  const simd::SumsView view = integral_->view(octave);
  const Range columns = columns_of(*integral_, octave, options_.layers);
  const int count = columns.size() + 2;
  const auto norm = [&](int of) { return hessian_norm(filter_size(octave, of)); };
  simd::FilterPair filters{{lobe_of(layer), 0}, {norm(layer), 0}};
  if (layer < options_.layers)
    filters = {{lobe_of(layer), lobe_of(layer + 1)}, {norm(layer), norm(layer + 1)}};
  const auto threshold = static_cast<float>(std::max(options_.hessian_threshold, 1e-6));
  const auto ring_row = [&](int y) { return buffers.ring.data() + y % 3 * stride_; };
  for (int y = block.begin - 1; y <= block.end; ++y) {
    simd::hessian_row(view, columns.first - 1, y, count, filters, ring_row(y));
    if (y <= block.begin) continue;
    const float* const around[3] = {ring_row(y - 2), ring_row(y - 1), ring_row(y)};
    const int found = simd::find_peaks(around, count, threshold, buffers.columns.data());
    for (int n = 0; n < found; ++n) {
      const int i = buffers.columns[n];
      block.peaks.push_back({around[1][i], static_cast<std::int16_t>(octave),
                             static_cast<std::int16_t>(layer), columns.first - 1 + i, y - 1});
    }
  }
}

void BlobSearch::search(const Integral& integral, const SurfOptions& options, Team& team,
                        int threads) {
  integral_ = &integral;
  options_ = options;
  stride_ = (integral.width() / 16 | 1) * 16 + 2 * simd::kSlack;
  buffers_.resize(threads);
  for (Buffers& buffers : buffers_) {
    buffers.ring.resize(static_cast<std::size_t>(3) * stride_);
    buffers.columns.resize(integral.width());
  }
  cut_into_blocks(threads);
  team.share(threads, blocks_used_, [&](int part, int thread) {
    search_block(blocks_[by_place_[part]], buffers_[thread]);
  });
}

std::optional<Candidate> examine(const Peak& peak, const Integral& integral,
                                 const SurfOptions& options) {
  const simd::SumsView view = integral.view(peak.octave);
  Candidate candidate{peak.octave, peak.layer, peak.x, peak.y, {}};
  const auto fill = [&](int layer, auto& plane) {
    simd::hessian_patch(view, peak.x, peak.y, lobe_of(layer),
                        hessian_norm(filter_size(peak.octave, layer)), plane[0].data());
  };
  const auto is_at_most = [](const auto& plane, float most) {
    return std::ranges::all_of(plane, [&](const auto& row) {
      return std::ranges::all_of(row, [&](float value) { return value <= most; });
    });
  };
  const float below_response = std::nextafter(peak.response, 0.0F);
  // The layer outside the pair refuses most; the pair's other layer was compared before, but for
  // an equal value. Of equal layers the upper one is taken.
  auto& [below, own, above] = candidate.around;
  fill(peak.layer, own);
  if (own[1][1] == peak.response) {
    fill(peak.layer - 1, below);
    if (!is_at_most(below, peak.response)) return std::nullopt;
    fill(peak.layer + 1, above);
    if (is_at_most(above, below_response)) return candidate;
    if (above[1][1] != peak.response) return std::nullopt;
  }
  if (peak.layer == options.layers) return std::nullopt;
  ++candidate.layer;
  below = own;
  fill(candidate.layer + 1, above);
  if (!is_at_most(above, below_response)) return std::nullopt;
  fill(candidate.layer, own);
  return candidate;
}

std::optional<Keypoint> refine(const Candidate& candidate, const Integral& integral) {
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
  if (!solve(xx, yy, ss, xy, xs, ys, gradient, offset)) return std::nullopt;
  for (const float value : offset)
    if (std::abs(value) >= 1) return std::nullopt;
  const auto step = static_cast<float>(1 << candidate.octave);
  const auto place = [&](int at, float off) {
    return (static_cast<float>(at) + 0.5F + off) * step - 0.5F - static_cast<float>(kMargin);
  };
  Keypoint keypoint;
  keypoint.x = place(candidate.x, offset[0]);
  keypoint.y = place(candidate.y, offset[1]);
  const auto size = static_cast<float>(filter_size(candidate.octave, candidate.layer));
  keypoint.scale = scale_of_filter(size + offset[2] * 6 * step);
  keypoint.response = candidate.response();
  const int lobe = lobe_of(candidate.layer), half = lobe + lobe / 2, middle = lobe / 2;
  const simd::SumsView view = integral.view(candidate.octave);
  const std::uint32_t* at = view.sums + candidate.y * view.stride + candidate.x;
  const auto box = [&](int x0, int y0, int x1, int y1) {
    const std::uint32_t *top = at + y0 * view.stride, *bottom = at + (y1 + 1) * view.stride;
    return static_cast<std::int32_t>(bottom[x1 + 1] - bottom[x0] - top[x1 + 1] + top[x0]);
  };
  const std::int32_t trace =
      box(-half, 1 - lobe, half, lobe - 1) - 3 * box(-middle, 1 - lobe, middle, lobe - 1) +
      box(1 - lobe, -half, lobe - 1, half) - 3 * box(1 - lobe, -middle, lobe - 1, middle);
  keypoint.laplacian = trace > 0 ? 1 : -1;
  return keypoint;
}

}  // namespace posevote::surf
