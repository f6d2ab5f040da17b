#include "posevote/feature/surf/select.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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

}  // namespace

void Selector::prepare(const Integral& integral, const SurfOptions& surf, const Options& options) {
  integral_ = &integral;
  surf_ = surf;
  options_ = options;
  peaks_.clear();
  batch_.clear();
}

void Selector::begin() {
  kept_.clear();
  keys_.clear();
  for (std::size_t i = 0; i < peaks_.size(); ++i) keys_.push_back(key_of(peaks_[i].response, i));
}

// The strongest of what is left, by index: in scan order the sums of one are in the cache for the
// next.
void Selector::next_batch() {
  batch_.clear();
  std::size_t size = keys_.size();
  const auto limit = static_cast<std::size_t>(options_.max_features);
  if (limit > 0 && !options_.spread) {
    if (kept_.size() >= limit) return;
    const std::size_t missing = limit - kept_.size();
    size = std::min(size, missing * 2 + 16);  // about half are refused
  }
  if (size < keys_.size()) std::nth_element(keys_.begin(), keys_.begin() + size, keys_.end());
  for (std::size_t i = 0; i < size; ++i) batch_.push_back(index_of(keys_[i]));
  keys_.erase(keys_.begin(), keys_.begin() + size);
  std::ranges::sort(batch_);
  examined_.resize(batch_.size());
}

void Selector::examine_batch(const Member& member) {
  const int count = static_cast<int>(batch_.size());
  for (int i = member.begin(count); i < member.end(count); ++i) {
    examined_[i].scale = 0;
    const auto candidate = examine(peaks_[batch_[i]], *integral_, surf_);
    if (!candidate) continue;
    const auto keypoint = refine(*candidate, *integral_);
    if (keypoint && is_inside_mask(options_.mask, keypoint->x, keypoint->y))
      examined_[i] = *keypoint;
  }
}

void Selector::keep_batch() {
  for (const Keypoint& keypoint : examined_)
    if (keypoint.scale > 0) kept_.push_back(keypoint);
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

// The leader's steps; when one fails, the others find the batch empty and end.
void Selector::lead(void (Selector::*step)()) {
  try {
    (this->*step)();
  } catch (...) {
    batch_.clear();
    throw;
  }
}

void Selector::select(const Member& member) {
  const bool leads = member.index() == 0;
  if (leads) lead(&Selector::begin);
  for (;;) {
    if (leads) lead(&Selector::next_batch);
    member.wait();
    if (batch_.empty()) break;
    examine_batch(member);
    member.wait();
    if (leads) lead(&Selector::keep_batch);
  }
  if (leads) finish();
  member.wait();
}

}  // namespace posevote::surf
