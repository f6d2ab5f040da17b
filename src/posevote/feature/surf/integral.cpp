#include "posevote/feature/surf/integral.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace posevote::surf {
namespace {

// Where threads share the work. The sums of a block's columns fit 16 bits.
constexpr int kBlockRows = 64;

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

void Integral::prepare(const cv::Mat& grey, bool smooth, int levels, int threads) {
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
  blocks_ = threads > 1 ? (height() + kBlockRows - 1) / kBlockRows : 1;
  buffers_.resize(threads);
  for (Buffers& buffers : buffers_) buffers.scratch.resize(grey.cols + 36);
  pixels_.resize(static_cast<std::size_t>(width()) * (blocks_ > 1 ? height() : 1));
  if (blocks_ == 1) return;
  columns_.resize(static_cast<std::size_t>(width()) * blocks_);
  above_.resize(width());
}

void Integral::fill_row(int y, std::uint16_t* scratch, std::uint8_t* row) const {
  const int source = std::clamp(y - kMargin, 0, grey_.rows - 1);
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
    for (std::ptrdiff_t x = 0; x <= levels_[k].width; ++x) row[x] = finer[2 * x];
  }
}

void Integral::sum_row(int y, const std::uint8_t* pixels) {
  std::uint32_t* row = levels_[0].row(y + 1);
  row[0] = 0;
  simd::integral_row(pixels, levels_[0].row(y) + 1, width(), row + 1);
  fill_levels(y + 1);
}

void Integral::sum_all(Buffers& buffers) {
  for (int y = 0; y < height(); ++y) {
    fill_row(y, buffers.scratch.data(), pixels(0));
    sum_row(y, pixels(0));
  }
}

int Integral::block_begin(int number) const {
  return std::min(number * kBlockRows, height());
}

// The pixels of a block, and the sums of its columns.
void Integral::load_block(int number, Buffers& buffers) {
  std::uint16_t* columns = &columns_[static_cast<std::size_t>(number) * width()];
  std::fill_n(columns, width(), std::uint16_t{0});
  for (int y = block_begin(number); y < block_begin(number + 1); ++y) {
    std::uint8_t* row = pixels(y);
    fill_row(y, buffers.scratch.data(), row);
    for (int x = 0; x < width(); ++x) columns[x] += row[x];
  }
}

// The last row of every block, from the sums of the columns: all sums need those above them.
void Integral::sum_blocks() {
  std::ranges::fill(above_, 0U);
  for (int number = 0; number < blocks_; ++number) {
    const std::uint16_t* columns = &columns_[static_cast<std::size_t>(number) * width()];
    for (int x = 0; x < width(); ++x) above_[x] += columns[x];
    std::uint32_t* last = levels_[0].row(block_begin(number + 1));
    last[0] = 0;
    std::partial_sum(above_.begin(), above_.end(), last + 1);
  }
}

void Integral::sum_block(int number) {
  const int end = block_begin(number + 1);
  for (int y = block_begin(number); y + 1 < end; ++y) sum_row(y, pixels(y));
  fill_levels(end);
}

void Integral::compute(const cv::Mat& grey, bool smooth, int levels, Team& team, int threads) {
  prepare(grey, smooth, levels, threads);
  std::fill_n(levels_[0].row(0), width() + 1, 0U);
  fill_levels(0);
  if (blocks_ == 1) {
    sum_all(buffers_[0]);
  } else {
    team.share(threads, blocks_, [&](int part, int thread) { load_block(part, buffers_[thread]); });
    sum_blocks();
    team.share(threads, blocks_, [&](int part, int) { sum_block(part); });
  }
  grey_.release();
}

}  // namespace posevote::surf
