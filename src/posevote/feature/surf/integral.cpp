#include "posevote/feature/surf/integral.hpp"

#include <algorithm>
#include <cstring>

namespace posevote::surf {
namespace {

// Rows an odd number of cache lines apart: rows 4096 bytes apart would share their cache sets.
std::ptrdiff_t padded_stride(int width) {
  const std::ptrdiff_t lines = width / 16 + 1;
  return (lines | 1) * 16;
}

std::uint8_t smooth_pixel(const std::uint8_t* const rows[5], int x, int width) {
  constexpr int kWeights[5] = {1, 4, 6, 4, 1};
  int sum = 128;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i)
      sum += kWeights[j] * kWeights[i] * rows[j][std::clamp(x + i - 2, 0, width - 1)];
  return static_cast<std::uint8_t>(sum >> 8);
}

void smooth_whole_row(const cv::Mat& grey, int y, std::uint16_t* scratch, std::uint8_t* out) {
  const std::uint8_t* rows[5];
  for (int i = 0; i < 5; ++i) rows[i] = grey.ptr(std::clamp(y + i - 2, 0, grey.rows - 1));
  const int edge = std::min(2, grey.cols), inner_end = std::max(edge, grey.cols - 2);
  for (int x = 0; x < edge; ++x) out[x] = smooth_pixel(rows, x, grey.cols);
  for (int x = inner_end; x < grey.cols; ++x) out[x] = smooth_pixel(rows, x, grey.cols);
  if (inner_end == edge) return;
  for (const std::uint8_t*& row : rows) row += edge;
  simd::smooth_row(rows, inner_end - edge, scratch, out + edge);
}

}  // namespace

void Integral::prepare(const cv::Mat& grey, bool smooth, int levels, int team_size) {
  grey_ = grey;
  smooth_ = smooth;
  levels_.resize(levels);
  for (int k = 0; k < levels; ++k) {
    Level& level = levels_[k];
    level.width = (grey.cols + 2 * kMargin) >> k;
    level.height = (grey.rows + 2 * kMargin) >> k;
    level.stride = padded_stride(level.width);
    level.sums.resize(static_cast<std::size_t>(level.stride) * (level.height + 1) + simd::kSlack);
  }
  pixel_stride_ = team_size > 1 ? width() : 0;
  pixels_.resize(static_cast<std::size_t>(pixel_stride_) * height() + width());
  parts_.resize(team_size);
  for (Part& part : parts_) {
    part.columns.resize(width());
    part.above.resize(width());
    part.scratch.resize(grey.cols + 36);
  }
}

void Integral::fill_row(int y, std::uint16_t* scratch) {
  const int source = std::clamp(y - kMargin, 0, grey_.rows - 1);
  std::uint8_t* row = pixels(y);
  std::uint8_t* inner = row + kMargin;
  if (smooth_)
    smooth_whole_row(grey_, source, scratch, inner);
  else
    std::memcpy(inner, grey_.ptr(source), grey_.cols);
  std::memset(row, inner[0], kMargin);
  std::memset(inner + grey_.cols, inner[grey_.cols - 1], kMargin);
}

// The row y of the sums, in every level that has it.
void Integral::fill_levels(int y) {
  for (std::size_t k = 1; k < levels_.size() && y % (1 << k) == 0; ++k) {
    const int at = y >> k;
    if (at > levels_[k].height) return;
    const std::uint32_t* finer = levels_[k - 1].row(2 * at);
    std::uint32_t* row = levels_[k].row(at);
    for (int x = 0; x <= levels_[k].width; ++x) row[x] = finer[2 * x];
  }
}

void Integral::compute(const Member& member) {
  const int begin = member.begin(height()), end = member.end(height());
  Part& part = parts_[member.index()];
  const bool alone = member.count() == 1;
  if (!alone) {
    std::ranges::fill(part.columns, 0U);
    for (int y = begin; y < end; ++y) {
      fill_row(y, part.scratch.data());
      const std::uint8_t* row = pixels(y);
      for (int x = 0; x < width(); ++x) part.columns[x] += row[x];
    }
    member.wait();
  }
  std::uint32_t sum = 0;
  for (int x = 0; x < width(); ++x) {
    for (int k = 0; k < member.index(); ++k) sum += parts_[k].columns[x];
    part.above[x] = sum;
  }
  if (begin == 0) {
    std::fill_n(levels_[0].row(0), width() + 1, 0U);
    fill_levels(0);
  }
  const std::uint32_t* above = part.above.data();
  for (int y = begin; y < end; ++y) {
    if (alone) fill_row(y, part.scratch.data());
    std::uint32_t* row = levels_[0].row(y + 1);
    row[0] = 0;
    simd::integral_row(pixels(y), above, width(), row + 1);
    fill_levels(y + 1);
    above = row + 1;
  }
  member.wait();
}

}  // namespace posevote::surf
