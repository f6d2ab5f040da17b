#include "posevote/feature/surf/select.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "posevote/feature/picture.hpp"

namespace posevote::surf {
namespace {

// Ascending keys: stronger first (the bits of positive numbers are in their order), then by index.
std::uint64_t key_of(float response, std::size_t index) {
  return static_cast<std::uint64_t>(~std::bit_cast<std::uint32_t>(response)) << 32 | index;
}
std::uint32_t index_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

// Classes of strength, a 32th of an octave each: the larger, the stronger.
constexpr int kClassBits = 13, kClasses = 1 << kClassBits;
int class_of(const Peak& peak) {
  return static_cast<int>(std::bit_cast<std::uint32_t>(peak.response) >> (31 - kClassBits));
}

}  // namespace

void Selector::count_peaks(const BlobSearch& search) {
  counts_.assign(kClasses, 0);
  search.for_each_peak([&](const Peak& peak) { ++counts_[class_of(peak)]; });
  next_class_ = kClasses;
}

// The strongest of what is left, in the order of the scan: the sums of one are in the cache for the
// next. False when nothing is left or wanted.
bool Selector::next_batch(const BlobSearch& search) {
  batch_.clear();
  int wanted = std::numeric_limits<int>::max(), found = 0;
  if (options_.max_features > 0 && !options_.spread) {
    const int missing = options_.max_features - static_cast<int>(kept_.size());
    if (missing <= 0) return false;
    wanted = missing > wanted / 2 - 16 ? wanted : missing * 2 + 16;  // about half are refused
  }
  int first = next_class_;
  while (first > 0 && found < wanted) found += counts_[--first];
  if (found == 0) return false;
  search.for_each_peak([&](const Peak& peak) {
    const int of = class_of(peak);
    if (of >= first && of < next_class_) batch_.push_back(peak);
  });
  next_class_ = first;
  examined_.resize(batch_.size());
  return true;
}

Keypoint Selector::examine_one(const Peak& peak, const Integral& integral,
                               const SurfOptions& surf) const {
  const auto candidate = examine(peak, integral, surf);
  if (!candidate) return {};
  const auto keypoint = refine(*candidate, integral);
  return keypoint && is_inside_mask(options_.mask, keypoint->x, keypoint->y) ? *keypoint
                                                                             : Keypoint{};
}

// The strongest of every cell first, then the second of every cell, and so on; four key points are
// wanted of a cell on average.
void Selector::spread() {
  std::ranges::sort(kept_, comes_before);
  const double area = static_cast<double>(options_.size.area());
  const int cell = std::max(1, static_cast<int>(std::sqrt(4 * area / options_.max_features)));
  const int columns = options_.size.width / cell + 1, rows = options_.size.height / cell + 1;
  taken_.assign(static_cast<std::size_t>(columns) * rows, 0);
  order_.clear();
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const int x = std::clamp(static_cast<int>(kept_[i].x), 0, options_.size.width - 1);
    const int y = std::clamp(static_cast<int>(kept_[i].y), 0, options_.size.height - 1);
    const auto rank = static_cast<std::uint64_t>(taken_[y / cell * columns + x / cell]++);
    order_.push_back(rank << 32 | i);
  }
}

void Selector::finish() {
  const bool limited =
      options_.max_features > 0 && kept_.size() > static_cast<std::size_t>(options_.max_features);
  if (limited && options_.spread) {
    spread();
  } else {
    order_.clear();
    for (std::size_t i = 0; i < kept_.size(); ++i) order_.push_back(key_of(kept_[i].response, i));
  }
  if (limited) {
    const auto end = order_.begin() + options_.max_features;
    std::nth_element(order_.begin(), end, order_.end());
    order_.erase(end, order_.end());
  }
  for (std::uint64_t& key : order_) key = key_of(kept_[index_of(key)].response, index_of(key));
  std::ranges::sort(order_);
  keypoints_.clear();
  for (const std::uint64_t key : order_) keypoints_.push_back(kept_[index_of(key)]);
  for (auto first = keypoints_.begin(); first != keypoints_.end();) {
    const auto last = std::find_if(first + 1, keypoints_.end(), [&](const Keypoint& other) {
      return other.response != first->response;
    });
    std::sort(first, last, comes_before);
    first = last;
  }
}

const std::vector<Keypoint>& Selector::select(const BlobSearch& search, const Integral& integral,
                                              const SurfOptions& surf, const Options& options,
                                              Team& team, int threads) {
  options_ = options;
  kept_.clear();
  count_peaks(search);
  while (next_batch(search)) {
    team.share_ranges(threads, static_cast<int>(batch_.size()), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) examined_[i] = examine_one(batch_[i], integral, surf);
    });
    for (const Keypoint& keypoint : examined_)
      if (keypoint.scale > 0) kept_.push_back(keypoint);
  }
  finish();
  return keypoints_;
}

}  // namespace posevote::surf
