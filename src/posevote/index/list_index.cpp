#include "posevote/index/list_index.hpp"

#include <algorithm>

#include "posevote/core/error.hpp"
#include "posevote/index/parallel.hpp"
#include "posevote/index/search.hpp"

namespace posevote {
ListIndex::ListIndex(std::string signature, const IndexOptions& options, const Coder& coder,
                     std::shared_ptr<const Quantizer> quantizer, std::vector<Part> parts,
                     std::size_t assigned)
    : signature_(std::move(signature)),
      options_(options),
      coder_(coder),
      quantizer_(std::move(quantizer)),
      parts_(std::move(parts)),
      assigned_(assigned) {}

NeighborLists ListIndex::search(const Features& scene, int k) const {
  return search_all(scene, k, nullptr);
}

NeighborLists ListIndex::search_rivals(const Features& scene, int k,
                                       const std::vector<int>& groups) const {
  return search_all(scene, k, &groups);
}

NeighborLists ListIndex::search_all(const Features& scene, int k,
                                    const std::vector<int>* groups) const {
  std::size_t all = 0;
  for (const Part& part : parts_) all += part.segment->size();
  const std::size_t most = std::min(static_cast<std::size_t>(std::max(0, k)), all);
  NeighborLists result(scene.size(), most);
  if (most == 0 || scene.empty()) return result;
  if (scene.descriptors.cols != coder_.dimension())
    throw Error(ErrorCode::feature_mismatch,
                "the scene's descriptors have " + std::to_string(scene.descriptors.cols) +
                    " values, the taught ones " + std::to_string(coder_.dimension()));
  parallel(options_.threads, scene.size(), [&](std::size_t begin, std::size_t end) {
    search_rows(*this, scene, most, groups, begin, end, result);
  });
  return result;
}

IndexStatistics ListIndex::statistics() const {
  IndexStatistics result;
  result.segments = parts_.size();
  result.assigned = assigned_;
  for (const Part& part : parts_) {
    result.bytes += part.segment->bytes() + part.numbers.capacity() * sizeof(Number);
    for (std::size_t u = 0; u < part.numbers.size(); ++u)
      if (part.numbers[u].present) result.descriptors += part.segment->units()[u].size();
  }
  if (quantizer_)
    for (const Centers& centers : *quantizer_) {
      result.lists += centers.lists();
      result.bytes += centers.codes().capacity();
    }
  return result;
}

}  // namespace posevote
