#include "posevote/index/index.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

constexpr int kLanes = 16;  ///< descriptors of a block lie side by side, dimension by dimension

struct Place {
  int view, feature;
};

/// All descriptors of one Laplacian sign.
struct Group {
  std::vector<Place> places;
  std::vector<float> blocks;  ///< [block][dimension][lane]
};

bool before(const Neighbor& a, const Neighbor& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  const auto view = [](const Neighbor& n) {
    return n.view < 0 ? std::numeric_limits<int>::max() : n.view;
  };
  if (a.view != b.view) return view(a) < view(b);
  return a.feature < b.feature;
}

/// The k best of what was offered, in a heap whose top is the worst.
class Best {
 public:
  explicit Best(int k) : k_(static_cast<std::size_t>(k)) {}

  [[nodiscard]] float limit() const {
    return heap_.size() < k_ ? std::numeric_limits<float>::infinity() : heap_.front().distance;
  }

  void offer(const Neighbor& neighbor) {
    if (heap_.size() == k_) {
      if (!before(neighbor, heap_.front())) return;
      std::pop_heap(heap_.begin(), heap_.end(), before);
      heap_.pop_back();
    }
    heap_.push_back(neighbor);
    std::push_heap(heap_.begin(), heap_.end(), before);
  }

  [[nodiscard]] std::vector<Neighbor> take() {
    std::sort_heap(heap_.begin(), heap_.end(), before);
    return std::move(heap_);
  }

 private:
  std::size_t k_;
  std::vector<Neighbor> heap_;
};

class ExactIndex : public Index {
 public:
  explicit ExactIndex(std::shared_ptr<const ModelSet> models) : models_(std::move(models)) {
    for (std::size_t v = 0; v < models_->views().size(); ++v)
      add(models_->views()[v].view->features, static_cast<int>(v), 0);
    int counted = 0;
    for (const Features& features : models_->impostors()) {
      add(features, -1, counted);
      counted += static_cast<int>(features.size());
    }
  }

  [[nodiscard]] std::vector<std::vector<Neighbor>> search(const Features& scene,
                                                          int k) const override {
    std::vector<std::vector<Neighbor>> result(scene.size());
    if (k <= 0 || dimension_ == 0) return result;
    if (!scene.empty() && scene.descriptors.cols != dimension_)
      throw Error(ErrorCode::feature_mismatch,
                  "the scene's descriptors have another length than the taught ones");
    for (std::size_t i = 0; i < scene.size(); ++i) {
      Best best(k);
      const int sign = scene.keypoints[i].laplacian;
      for (int group = -1; group <= 1; ++group)
        if (sign * group >= 0)
          scan(groups_[static_cast<std::size_t>(group + 1)],
               scene.descriptors.ptr<float>(static_cast<int>(i)), best);
      result[i] = best.take();
    }
    return result;
  }

 private:
  void add(const Features& features, int view, int first) {
    if (features.empty()) return;
    dimension_ = features.descriptors.cols;
    for (int i = 0; i < static_cast<int>(features.size()); ++i) {
      Group& group =
          groups_[static_cast<std::size_t>(1 + features.keypoints[std::size_t(i)].laplacian)];
      const std::size_t lane = group.places.size() % kLanes;
      if (lane == 0) group.blocks.resize(group.blocks.size() + std::size_t(kLanes * dimension_));
      float* block = group.blocks.data() + group.blocks.size() - kLanes * dimension_;
      const float* row = features.descriptors.ptr<float>(i);
      for (int d = 0; d < dimension_; ++d) block[std::size_t(d) * kLanes + lane] = row[d];
      group.places.push_back({view, first + i});
    }
  }

  void scan(const Group& group, const float* query, Best& best) const {
    for (std::size_t start = 0; start < group.places.size(); start += kLanes) {
      const float* block = group.blocks.data() + start * std::size_t(dimension_);
      std::array<float, kLanes> squared{};
      for (int d = 0; d < dimension_; ++d)
        for (int lane = 0; lane < kLanes; ++lane) {
          const float difference = query[d] - block[d * kLanes + lane];
          squared[std::size_t(lane)] += difference * difference;
        }
      const std::size_t lanes = std::min<std::size_t>(kLanes, group.places.size() - start);
      const float limit = best.limit();
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const float distance = std::sqrt(squared[lane]);
        const Place& place = group.places[start + lane];
        if (distance <= limit) best.offer({place.view, place.feature, distance});
      }
    }
  }

  std::shared_ptr<const ModelSet> models_;
  int dimension_ = 0;
  std::array<Group, 3> groups_;  ///< Laplacian -1, unknown, +1
};

}  // namespace

void IndexOptions::describe(OptionList& list) {
  list.add("method", method, {"auto", "exact", "approximate"},
           "How neighbours are searched: all descriptors (exact), lists of similar ones "
           "(approximate), or by the number of descriptors (auto).");
}

std::shared_ptr<const Index> make_index(std::shared_ptr<const ModelSet> models,
                                        const IndexOptions& options, const Index* /*previous*/) {
  validate_options(options);
  return std::make_shared<ExactIndex>(std::move(models));
}

}  // namespace posevote
