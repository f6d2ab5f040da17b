#include "posevote/index/list_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posevote/core/error.hpp"
#include "posevote/index/parallel.hpp"

namespace posevote {
namespace {

/// What products miss when lengths are not quite 1, as those of half floats.
constexpr float kLengthError = 1e-3F;
constexpr std::size_t kAhead = 2;  ///< queries whose rows are on their way while one is ranked
constexpr std::size_t kChunkBlocks = 64;  // 64 KB of codes for 64 dimensions: half of an L2 cache

bool before(const Neighbor& a, const Neighbor& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  // The pool, -1, becomes the largest view.
  if (a.view != b.view) return static_cast<unsigned>(a.view) < static_cast<unsigned>(b.view);
  return a.feature < b.feature;
}

/// A taught descriptor whose scalar product with the query is among the best so far.
struct Candidate {
  float product;         ///< by the codes
  std::uint16_t source;  ///< part * kSigns + sign
  std::uint32_t entry;
};

/// The candidates of one query: all that were offered with at least (k-th best - margin).
class Shortlist {
 public:
  Shortlist(std::size_t k, float margin) : k_(k), margin_(margin), trigger_(4 * k_ + 64) {}

  [[nodiscard]] float limit() const noexcept { return limit_; }
  [[nodiscard]] const std::vector<Candidate>& candidates() const noexcept { return candidates_; }

  void add(const Candidate& candidate) {
    candidates_.push_back(candidate);
    if (candidates_.size() >= trigger_) tighten();
  }

  void tighten() {
    if (candidates_.size() < k_) return;
    const auto kth = candidates_.begin() + static_cast<std::ptrdiff_t>(k_ - 1);
    std::nth_element(candidates_.begin(), kth, candidates_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.product > b.product; });
    limit_ = kth->product - margin_;
    std::erase_if(candidates_, [this](const Candidate& c) { return c.product < limit_; });
    trigger_ = std::max(trigger_, 2 * candidates_.size());
  }

 private:
  std::size_t k_;
  float margin_;
  std::size_t trigger_;
  float limit_ = -std::numeric_limits<float>::infinity();
  std::vector<Candidate> candidates_;
};

/// One search for some rows of a scene. What is found for a row does not depend on the others.
class Search {
 public:
  Search(const ListIndex& index, const Features& scene, int k, std::size_t begin, std::size_t end)
      : index_(index),
        coder_(index.coder()),
        scene_(scene),
        k_(static_cast<std::size_t>(k)),
        begin_(begin),
        count_(end - begin),
        code_bytes_(coder_.quads() * 4) {
    const bool certain = index_.options().method == "exact";
    float residual = 0;
    for (const auto& part : index_.parts())
      residual = std::max(
          residual, certain ? part.segment->largest_residual() : part.segment->usual_residual());
    codes_.resize(count_ * code_bytes_);
    bases_.resize(count_);
    shortlists_.reserve(count_);
    for (std::size_t q = 0; q < count_; ++q) {
      const QueryCode code = coder_.encode_query(row(q), &codes_[q * code_bytes_]);
      const float error = kLengthError + coder_.error(code.residual, residual, 1, certain);
      // Two errors meet in a comparison: they add, or, as chance has it, their squares do.
      shortlists_.emplace_back(k_, error * (certain ? 2.0F : 1.42F));
      scales_.push_back(code.scale);
      errors_.push_back(error);
    }
  }

  void run(std::vector<std::vector<Neighbor>>& result) {
    for (std::size_t sign = 0; sign < kSigns; ++sign) look_through(sign);
    for (std::size_t q = 0; q < std::min(kAhead, count_); ++q) prepare_rank(q);
    for (std::size_t q = 0; q < count_; ++q) {
      if (q + kAhead < count_) prepare_rank(q + kAhead);
      result[begin_ + q] = rank(q);
    }
  }

 private:
  [[nodiscard]] const float* row(std::size_t q) const {
    return scene_.descriptors.ptr<float>(static_cast<int>(begin_ + q));
  }

  /// Searches the lists of one sign for all queries that may have neighbours there. The nearest
  /// list of each comes first: its limit keeps most of the others' codes out.
  void look_through(std::size_t sign) {
    std::vector<std::uint32_t> queries;
    for (std::size_t q = 0; q < count_; ++q) {
      const std::size_t own = sign_class(scene_.keypoints[begin_ + q].laplacian);
      if (own == sign || own == 1 || sign == 1) queries.push_back(static_cast<std::uint32_t>(q));
    }
    const Centers& centers = (*index_.quantizer())[sign];
    const std::size_t probes =
        std::min(static_cast<std::size_t>(index_.options().probes), centers.lists());
    std::vector<std::uint16_t> lists(queries.size() * probes);
    for (std::size_t first = 0; first < queries.size(); first += kMaxQueries)
      centers.nearest(coder_, group(queries.data() + first, queries.size() - first), probes,
                      &lists[first * probes]);
    visit(sign, queries, lists, probes, 0, 1);
    for (const std::uint32_t q : queries) shortlists_[q].tighten();
    visit(sign, queries, lists, probes, 1, probes);
  }

  [[nodiscard]] QueryGroup group(const std::uint32_t* queries, std::size_t count) const {
    QueryGroup result{};
    result.count = std::min(count, kMaxQueries);
    for (std::size_t i = 0; i < result.count; ++i)
      result.codes[i] = &codes_[queries[i] * code_bytes_];
    return result;
  }

  /// Scans columns [first, last) of `lists`, list by list, so that each is read only once.
  void visit(std::size_t sign, const std::vector<std::uint32_t>& queries,
             const std::vector<std::uint16_t>& lists, std::size_t probes, std::size_t first,
             std::size_t last) {
    const std::size_t list_count = (*index_.quantizer())[sign].lists();
    std::vector<std::uint32_t> ends(list_count + 1);
    for (std::size_t i = 0; i < queries.size(); ++i)
      for (std::size_t p = first; p < last; ++p) ++ends[lists[i * probes + p] + 1U];
    for (std::size_t l = 0; l < list_count; ++l) ends[l + 1] += ends[l];
    std::vector<std::uint32_t> visitors(ends.back());
    for (std::size_t i = 0; i < queries.size(); ++i)
      for (std::size_t p = first; p < last; ++p)
        visitors[ends[lists[i * probes + p]]++] = queries[i];
    // Now ends[l] is the end of list l, and the end of the one before is its beginning.
    for (std::size_t l = 0; l < list_count; ++l) {
      const std::size_t begin = l == 0 ? 0 : ends[l - 1];
      const float* center = (*index_.quantizer())[sign].center(l);
      for (std::size_t i = begin; i < ends[l]; ++i)
        bases_[visitors[i]] = center ? product(row(visitors[i]), center, coder_.dimension()) : 0.0F;
      for (std::size_t part = 0; part < index_.parts().size(); ++part)
        scan(part, sign, l, visitors.data() + begin, ends[l] - begin);
    }
  }

  void scan(std::size_t part, std::size_t sign, std::size_t list, const std::uint32_t* queries,
            std::size_t query_count) {
    const Segment::Lists& lists = index_.parts()[part].segment->lists(sign);
    const std::size_t end = lists.starts[list + 1];
    for (std::size_t block = lists.starts[list]; block < end; block += kChunkBlocks) {
      const std::size_t blocks = std::min(kChunkBlocks, end - block);
      for (std::size_t first = 0; first < query_count; first += kMaxQueries) {
        const QueryGroup some = group(queries + first, query_count - first);
        dots(&lists.codes[block * coder_.block_bytes()], blocks, coder_.quads(), some, products_,
             kChunkBlocks * kBlockLanes);
        for (std::size_t q = 0; q < some.count; ++q)
          collect(part, sign, block * kBlockLanes, blocks * kBlockLanes,
                  products_ + q * kChunkBlocks * kBlockLanes, queries[first + q]);
      }
    }
  }

  /// Products of a query and the codes of a list, of which products[0] is entry `first_entry`. They
  /// are less by the product of the query and the centre.
  void collect(std::size_t part, std::size_t sign, std::size_t first_entry, std::size_t count,
               const std::int16_t* products, std::uint32_t q) {
    const Centers& centers = (*index_.quantizer())[sign];
    const float scale = scales_[q] * centers.member_scale();
    const float base = bases_[q];
    Shortlist& shortlist = shortlists_[q];
    const float lowest = std::ceil((shortlist.limit() - base) * scale);
    if (lowest > 32767) return;
    const std::size_t found = find_at_least(
        products, count, static_cast<std::int16_t>(std::max(lowest, -32768.0F)), positions_);
    const auto source = static_cast<std::uint16_t>(part * kSigns + sign);
    const ListIndex::Part& from = index_.parts()[part];
    for (std::size_t i = 0; i < found; ++i) {
      const std::size_t entry = first_entry + positions_[i];
      const std::uint32_t unit = from.segment->lists(sign).entries[entry].unit;
      if (unit == Segment::kNone || !from.numbers[unit].present) continue;
      const float product = base + static_cast<float>(products[positions_[i]]) / scale;
      shortlist.add({product, source, static_cast<std::uint32_t>(entry)});
    }
  }

  /// The k best of the candidates of a query by exact distance. Of those that are not among the k
  /// best by their codes, only those are measured that the error of the codes leaves a chance.
  [[nodiscard]] std::vector<Neighbor> rank(std::size_t q) {
    const std::vector<Candidate>& candidates = shortlists_[q].candidates();
    const std::size_t wanted = std::min(k_, candidates.size());
    std::vector<Neighbor> result;
    result.reserve(candidates.size());
    float farthest = 0;
    for (std::size_t i = 0; i < wanted; ++i) {
      result.push_back(measure(q, candidates[i]));
      farthest = std::max(farthest, result.back().distance);
    }
    const float lowest = 1 - farthest * farthest / 2 - errors_[q];
    for (std::size_t i = wanted; i < candidates.size(); ++i)
      if (candidates[i].product >= lowest) result.push_back(measure(q, candidates[i]));
    std::partial_sort(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(wanted),
                      result.end(), before);
    result.resize(wanted);
    return result;
  }

  /// Asks for the rows that `rank` will read, which are scattered over the memory.
  void prepare_rank(std::size_t q) {
    shortlists_[q].tighten();
    const std::vector<Candidate>& candidates = shortlists_[q].candidates();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const cv::Mat& rows = unit_of(candidates[i]).descriptors;
      const uchar* row = rows.ptr(static_cast<int>(entry_of(candidates[i]).feature));
      const std::size_t bytes = rows.elemSize() * static_cast<std::size_t>(rows.cols);
      for (std::size_t offset = 0; offset < bytes; offset += 64) __builtin_prefetch(row + offset);
    }
  }

  [[nodiscard]] const Segment::Entry& entry_of(const Candidate& candidate) const {
    const Segment& segment = *index_.parts()[candidate.source / kSigns].segment;
    return segment.lists(candidate.source % kSigns).entries[candidate.entry];
  }

  [[nodiscard]] const Unit& unit_of(const Candidate& candidate) const {
    const Segment& segment = *index_.parts()[candidate.source / kSigns].segment;
    return segment.units()[entry_of(candidate).unit];
  }

  [[nodiscard]] Neighbor measure(std::size_t q, const Candidate& candidate) {
    const Segment::Entry& entry = entry_of(candidate);
    const ListIndex::Number& number = index_.parts()[candidate.source / kSigns].numbers[entry.unit];
    const float* taught =
        read_row(unit_of(candidate).descriptors, static_cast<int>(entry.feature), buffer_);
    return {number.view, number.first + static_cast<int>(entry.feature),
            distance(row(q), taught, coder_.dimension())};
  }

  const ListIndex& index_;
  const Coder& coder_;
  const Features& scene_;
  std::size_t k_, begin_, count_, code_bytes_;
  std::vector<std::int8_t> codes_;
  std::vector<Shortlist> shortlists_;
  std::vector<float> scales_, errors_;  ///< of the codes and the products of each query
  std::vector<float> bases_;            ///< product of each query and the centre of this list
  std::vector<float> buffer_;
  std::int16_t products_[kMaxQueries * kChunkBlocks * kBlockLanes];
  std::uint32_t positions_[kChunkBlocks * kBlockLanes];
};

}  // namespace

ListIndex::ListIndex(std::string signature, const IndexOptions& options, const Coder& coder,
                     std::shared_ptr<const Quantizer> quantizer, std::vector<Part> parts)
    : signature_(std::move(signature)),
      options_(options),
      coder_(coder),
      quantizer_(std::move(quantizer)),
      parts_(std::move(parts)) {}

std::vector<std::vector<Neighbor>> ListIndex::search(const Features& scene, int k) const {
  std::vector<std::vector<Neighbor>> result(scene.size());
  if (k <= 0 || scene.empty() || parts_.empty()) return result;
  if (scene.descriptors.cols != coder_.dimension())
    throw Error(ErrorCode::feature_mismatch,
                "the scene's descriptors have " + std::to_string(scene.descriptors.cols) +
                    " values, the taught ones " + std::to_string(coder_.dimension()));
  parallel(options_.threads, scene.size(), [&](std::size_t begin, std::size_t end) {
    if (begin < end) Search(*this, scene, k, begin, end).run(result);
  });
  return result;
}

IndexStatistics ListIndex::statistics() const {
  IndexStatistics result;
  result.segments = parts_.size();
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
