// The best candidates of one query while lists are scanned for it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>

#include "posevote/index/dots.hpp"

namespace posevote {

/// Products with 16 bits, so that they can be compared many at once: a step is 20 times finer than
/// what the rounding of the codes does to a product.
inline constexpr float kKeyScale = 30000;

/// Candidates with a key of at least (k-th best key - margin), and some more; where groups are
/// told, at least (best key of any group but that of the best - margin). Keys and places of the
/// candidates lie in memory that is lent; a list that needs more takes its own.
class Shortlist {
 public:
  /// `capacity` is a multiple of kBlockLanes, at least k.
  Shortlist(std::size_t k, int margin, std::int16_t* keys, std::uint32_t* places,
            std::size_t capacity)
      : k_(k), margin_(margin), keys_(keys), places_(places), capacity_(capacity) {}

  static constexpr int kNoLimit = -32768;
  static constexpr int kNoGroup = -2;
  /// Keys below this are of no use.
  [[nodiscard]] int limit() const noexcept { return limit_; }
  [[nodiscard]] int margin() const noexcept { return margin_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::int16_t key(std::size_t i) const noexcept { return keys_[i]; }
  [[nodiscard]] std::uint32_t place(std::size_t i) const noexcept { return places_[i]; }

  void add(std::int16_t key, std::uint32_t place) {
    if (size_ == capacity_) make_room();
    keys_[size_] = key;
    places_[size_++] = place;
  }

  void add(std::int16_t key, std::uint32_t place, int group) {
    add(key, place);
    if (group == group_) {
      best_ = std::max<int>(best_, key);
    } else if (key > best_) {
      limit_ = std::max(limit_, best_ - margin_);
      best_ = key;
      group_ = group;
    } else {
      limit_ = std::max(limit_, key - margin_);
    }
  }

  /// Drops what is of no use.
  void tighten() {
    if (size_ >= k_) {
      const std::size_t padded = (size_ + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
      std::fill(keys_ + size_, keys_ + padded, std::int16_t{-32768});
      limit_ = std::max(limit_, kth_largest(keys_, padded, k_) - margin_);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const std::int16_t key = keys_[i];
      keys_[kept] = key;
      places_[kept] = places_[i];
      kept += key >= limit_ ? 1 : 0;
    }
    size_ = kept;
  }

 private:
  void make_room() {
    tighten();
    if (size_ <= capacity_ / 2) return;
    const std::size_t larger = 2 * capacity_;
    auto keys = std::make_unique<std::int16_t[]>(larger);
    auto places = std::make_unique<std::uint32_t[]>(larger);
    std::copy(keys_, keys_ + size_, keys.get());
    std::copy(places_, places_ + size_, places.get());
    keys_ = keys.get();
    places_ = places.get();
    capacity_ = larger;
    own_keys_ = std::move(keys);
    own_places_ = std::move(places);
  }

  std::size_t k_;
  int margin_;
  int limit_ = kNoLimit;
  int group_ = kNoGroup, best_ = kNoLimit;  ///< of the best candidate
  std::int16_t* keys_;
  std::uint32_t* places_;
  std::size_t size_ = 0, capacity_;
  std::unique_ptr<std::int16_t[]> own_keys_;
  std::unique_ptr<std::uint32_t[]> own_places_;
};

}  // namespace posevote
