// What a search for nearest neighbours found.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <vector>

namespace posevote {

/// A taught descriptor near a scene descriptor.
struct Neighbor {
  int view = -1;       ///< index into ModelSet::views(); -1: a feature of the impostor pool
  int feature = -1;    ///< index into the view's features (or into the pool, counted through)
  float distance = 0;  ///< Euclidean, descriptors have length 1, so in [0, 2]
};

/// Neighbours of one query, nearest first; a view into NeighborLists.
class NeighborList {
 public:
  NeighborList(const Neighbor* first, std::size_t size) : first_(first), size_(size) {}
  [[nodiscard]] const Neighbor* begin() const noexcept { return first_; }
  [[nodiscard]] const Neighbor* end() const noexcept { return first_ + size_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] const Neighbor& operator[](std::size_t i) const noexcept { return first_[i]; }
  [[nodiscard]] const Neighbor& front() const noexcept { return first_[0]; }
  [[nodiscard]] const Neighbor& back() const noexcept { return first_[size_ - 1]; }

 private:
  const Neighbor* first_;
  std::size_t size_;
};

/// The neighbours of some queries in one array: list i has up to `capacity` of them.
class NeighborLists {
 public:
  NeighborLists() = default;
  NeighborLists(std::size_t count, std::size_t capacity)
      : capacity_(capacity), sizes_(count), neighbors_(count * capacity) {}
  NeighborLists(std::initializer_list<std::vector<Neighbor>> lists) {
    for (const auto& list : lists) capacity_ = std::max(capacity_, list.size());
    for (const auto& list : lists) {
      sizes_.push_back(list.size());
      neighbors_.insert(neighbors_.end(), list.begin(), list.end());
      neighbors_.resize(sizes_.size() * capacity_);
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return sizes_.size(); }
  [[nodiscard]] NeighborList operator[](std::size_t i) const noexcept {
    return {neighbors_.data() + i * capacity_, sizes_[i]};
  }

  /// Room for the `capacity` neighbours of list i, of which the first `size` are to be valid.
  [[nodiscard]] Neighbor* fill(std::size_t i, std::size_t size) noexcept {
    sizes_[i] = size;
    return neighbors_.data() + i * capacity_;
  }

  /// Leaves the first `size` of list i.
  void shorten(std::size_t i, std::size_t size) noexcept { sizes_[i] = size; }

 private:
  std::size_t capacity_ = 0;
  std::vector<std::size_t> sizes_;
  std::vector<Neighbor> neighbors_;
};

}  // namespace posevote
