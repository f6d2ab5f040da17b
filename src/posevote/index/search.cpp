#include "posevote/index/search.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <opencv2/core/hal/hal.hpp>

#include "posevote/index/shortlist.hpp"

namespace posevote {
namespace {

/// What products miss when lengths are not quite 1, as those of half floats.
constexpr float kLengthError = 1e-3F;
/// Distance to which the rounding of a query is reckoned to matter; see Search::encode.
constexpr float kUsualDistance = 0.5F;
constexpr float kAllKeys = 65535;         // a margin that lets all through
constexpr std::size_t kBatch = 512;       // their shortlists about fit in an L2 cache
constexpr std::size_t kChunkBlocks = 64;  // 64 KB of codes for 64 dimensions: half of an L2 cache
constexpr std::size_t kChunk = kChunkBlocks * kBlockLanes;
constexpr std::size_t kFewCandidates = 32;  // most queries with groups have fewer
constexpr std::size_t kAhead = 2;  ///< queries whose rows are on their way while one is ranked

bool before(const Neighbor& a, const Neighbor& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  // The pool, -1, becomes the largest view.
  if (a.view != b.view) return static_cast<unsigned>(a.view) < static_cast<unsigned>(b.view);
  return a.feature < b.feature;
}

/// The lowest for what is not a number.
std::int16_t clamp16(float v) {
  return static_cast<std::int16_t>(v > -32768.0F ? std::min(v, 32767.0F) : -32768.0F);
}

/// Keys are kKeyScale * product: key = slope * (product of codes) + base.
struct Query {
  QueryCode code;
  float shift = 0;  ///< added to the key of every candidate
};

/// A list that is to be scanned for a query.
struct Visit {
  std::uint32_t query;
  float base;  ///< key of a member whose code is 0
};

/// Codes of one part and sign among all places.
struct Source {
  const ListIndex::Part* part;
  std::size_t sign;
  std::uint32_t first_place;
  bool some_absent;
};

class Search {
 public:
  Search(const ListIndex& index, const Features& scene, std::size_t k,
         const std::vector<int>* groups)
      : index_(index),
        coder_(index.coder()),
        scene_(scene),
        k_(k),
        groups_(groups),
        certain_(index.options().method == "exact"),
        code_bytes_(coder_.quads() * 4),
        capacity_(((groups ? std::max(k, kFewCandidates) : 2 * k + 64) + kBlockLanes - 1) /
                  kBlockLanes * kBlockLanes) {
    std::uint32_t place = 0;
    for (const auto& part : index_.parts()) {
      residual_ = std::max(
          residual_, certain_ ? part.segment->largest_residual() : part.segment->usual_residual());
      const bool some_absent = std::any_of(part.numbers.begin(), part.numbers.end(),
                                           [](const auto& number) { return !number.present; });
      for (std::size_t sign = 0; sign < kSigns; ++sign) {
        sources_.push_back({&part, sign, place, some_absent});
        place += static_cast<std::uint32_t>(part.segment->lists(sign).entries.size());
      }
    }
  }

  void run(std::size_t begin, std::size_t end, NeighborLists& result) {
    begin_ = begin;
    count_ = end - begin;
    encode();
    for (std::size_t sign = 0; sign < kSigns; ++sign) look_through(sign);
    // What a query needs next is on its way from memory while others are at work.
    for (std::size_t step = 0; step < count_ + 2 * kAhead; ++step) {
      if (step < count_) choose(step);
      if (step >= kAhead && step - kAhead < count_) locate(step - kAhead);
      if (step >= 2 * kAhead) rank(step - 2 * kAhead, result);
    }
  }

 private:
  [[nodiscard]] const float* row(std::size_t q) const {
    return scene_.descriptors.ptr<float>(static_cast<int>(begin_ + q));
  }

  /// A product of codes is off by e * x, e what the rounding of the query lost and x the taught
  /// descriptor. As x = query + difference, most of it is e * query, which is known and put right,
  /// except for a search that has to be certain.
  void encode() {
    codes_.resize(count_ * code_bytes_);
    queries_.resize(count_);
    keys_.resize(count_ * capacity_);
    places_.resize(count_ * capacity_);
    shortlists_.clear();
    shortlists_.reserve(count_);
    for (std::size_t q = 0; q < count_; ++q) {
      Query& query = queries_[q];
      query.code = coder_.encode_query(row(q), &codes_[q * code_bytes_]);
      const float error =
          coder_.error(query.code.residual, residual_, certain_ ? 1.0F : kUsualDistance, certain_);
      query.shift = certain_ ? 0.0F : kKeyScale * query.code.lost;
      // Two errors meet in a comparison: they add, or, as chance has it, their squares do.
      const float margin = certain_ ? 2 * (error + kLengthError) : 1.42F * error;
      shortlists_.emplace_back(k_, static_cast<int>(std::min(kAllKeys, kKeyScale * margin)) + 1,
                               &keys_[q * capacity_], &places_[q * capacity_], capacity_);
    }
  }

  /// Searches the lists of one sign for all queries that may have neighbours there. The nearest
  /// list of each comes first: its limit keeps most of the others' codes out.
  void look_through(std::size_t sign) {
    seekers_.clear();
    for (std::size_t q = 0; q < count_; ++q) {
      const std::size_t own = sign_class(scene_.keypoints[begin_ + q].laplacian);
      if (own == sign || own == 1 || sign == 1) seekers_.push_back(static_cast<std::uint32_t>(q));
    }
    const Centers& centers = (*index_.quantizer())[sign];
    const std::size_t probes =
        std::min(static_cast<std::size_t>(index_.options().probes), centers.lists());
    probes_.resize(seekers_.size() * probes);
    for (std::size_t first = 0; first < seekers_.size(); first += kMaxQueries) {
      QueryGroup group{};
      group.count = std::min(kMaxQueries, seekers_.size() - first);
      for (std::size_t i = 0; i < group.count; ++i)
        group.codes[i] = &codes_[seekers_[first + i] * code_bytes_];
      centers.nearest(coder_, group, probes, buffer_, &probes_[first * probes]);
    }
    visit(sign, probes, 0, 1);
    for (const std::uint32_t q : seekers_) shortlists_[q].tighten();
    visit(sign, probes, 1, probes);
  }

  /// Scans columns [first, last) of `probes_`, list by list, so that each is read only once.
  void visit(std::size_t sign, std::size_t probes, std::size_t first, std::size_t last) {
    const std::size_t list_count = (*index_.quantizer())[sign].lists();
    ends_.assign(list_count + 1, 0);
    for (std::size_t i = 0; i < seekers_.size(); ++i)
      for (std::size_t p = first; p < last; ++p) ++ends_[probes_[i * probes + p].list + 1U];
    for (std::size_t l = 0; l < list_count; ++l) ends_[l + 1] += ends_[l];
    visits_.resize(ends_.back());
    for (std::size_t i = 0; i < seekers_.size(); ++i) {
      const Query& query = queries_[seekers_[i]];
      const float slope = kKeyScale / (query.code.scale * kUnitScale);
      for (std::size_t p = first; p < last; ++p) {
        const Centers::Probe& probe = probes_[i * probes + p];
        visits_[ends_[probe.list]++] = {seekers_[i],
                                        slope * static_cast<float>(probe.product) + query.shift};
      }
    }
    // Now ends_[l] is the end of list l, and the end of the one before is its beginning.
    for (std::size_t l = 0; l < list_count; ++l) {
      const std::size_t begin = l == 0 ? 0 : ends_[l - 1];
      if (begin == ends_[l]) continue;
      for (std::size_t s = sign; s < sources_.size(); s += kSigns)
        scan_list(sources_[s], l, visits_.data() + begin, ends_[l] - begin);
    }
  }

  void scan_list(const Source& source, std::size_t list, const Visit* visits, std::size_t count) {
    const Segment::Lists& lists = source.part->segment->lists(source.sign);
    const std::size_t begin = lists.starts[list] * kBlockLanes;
    const std::size_t end = begin + lists.sizes[list];
    const float member_scale = (*index_.quantizer())[source.sign].member_scale();
    for (std::size_t chunk = begin; chunk < end; chunk += kChunk) {
      const std::size_t codes = std::min(kChunk, end - chunk);
      for (std::size_t v = 0; v < count;) {
        std::size_t used = 0;
        for (; v < count && used < kMaxQueries; ++v)
          used += prepare_scan(visits[v], member_scale, used) ? 1 : 0;
        std::uint32_t some =
            scan(&lists.codes[chunk / kBlockLanes * coder_.block_bytes()],
                 (codes + kBlockLanes - 1) / kBlockLanes, coder_.quads(), scans_.data(), used);
        for (; some != 0; some &= some - 1)
          collect(source, chunk, codes, static_cast<std::size_t>(std::countr_zero(some)),
                  member_scale);
      }
    }
  }

  /// False when no product of codes can be large enough.
  bool prepare_scan(const Visit& visit, float member_scale, std::size_t slot) {
    const Query& query = queries_[visit.query];
    const float lowest = (static_cast<float>(shortlists_[visit.query].limit()) - visit.base) *
                         query.code.scale * member_scale * (1 / kKeyScale);
    if (lowest > 32767) return false;
    scans_[slot] = {&codes_[visit.query * code_bytes_], query.code.offset, clamp16(lowest),
                    &products_[slot * kChunk], &found_[slot * kChunkBlocks]};
    scanned_[slot] = visit;
    return true;
  }

  /// Takes what was found among the `count` codes from `first_entry` on.
  void collect(const Source& source, std::size_t first_entry, std::size_t count, std::size_t slot,
               float member_scale) {
    const Visit& visit = scanned_[slot];
    const std::int16_t* products = &products_[slot * kChunk];
    Shortlist& shortlist = shortlists_[visit.query];
    const float slope = kKeyScale / (queries_[visit.query].code.scale * member_scale);
    const auto add = [&](std::size_t i) {
      const std::int16_t key = clamp16(slope * static_cast<float>(products[i]) + visit.base);
      if (key < shortlist.limit()) return;
      const std::uint32_t place = source.first_place + static_cast<std::uint32_t>(first_entry + i);
      if (groups_)
        shortlist.add(key, place, group_of(source, first_entry + i));
      else
        shortlist.add(key, place);
    };
    if (shortlist.limit() == Shortlist::kNoLimit && !source.some_absent && count > k_) {
      collect_first(slot, count, static_cast<float>(shortlist.margin()) / slope, shortlist, add);
      return;
    }
    std::uint16_t* found = &found_[slot * kChunkBlocks];
    const std::size_t blocks = (count + kBlockLanes - 1) / kBlockLanes;
    if (count % kBlockLanes != 0)
      found[blocks - 1] &= static_cast<std::uint16_t>((1U << count % kBlockLanes) - 1);
    constexpr std::size_t kWord = 4;  // blocks in one word of bits
    std::fill(found + blocks, found + (blocks + kWord - 1) / kWord * kWord, std::uint16_t{0});
    for (std::size_t block = 0; block < blocks; block += kWord) {
      std::uint64_t bits;
      std::memcpy(&bits, found + block, sizeof bits);
      for (; bits != 0; bits &= bits - 1) {
        const std::size_t i =
            block * kBlockLanes + static_cast<std::size_t>(std::countr_zero(bits));
        if (!source.some_absent || is_present(source, first_entry + i)) add(i);
      }
    }
  }

  /// Takes the first codes that a query sees, as far as they may be among the k best of them. With
  /// groups a few are enough if they are of two groups.
  template <class Add>
  void collect_first(std::size_t slot, std::size_t count, float margin, const Shortlist& shortlist,
                     const Add& add) {
    std::int16_t* products = &products_[slot * kChunk];
    const std::size_t padded = (count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
    std::fill(products + count, products + padded, std::int16_t{-32768});
    best_.resize(padded);
    constexpr std::size_t kFew = 6;
    int taken = 32768;  // products from here on
    for (std::size_t wanted = groups_ ? std::min(k_, kFew) : k_;; wanted = k_) {
      const float lowest = static_cast<float>(kth_largest(products, padded, wanted)) - margin - 1;
      const std::int16_t limit = clamp16(std::max(lowest, -32767.0F));
      const std::size_t enough = find_at_least(products, padded, limit, best_.data());
      for (std::size_t i = 0; i < enough; ++i)
        if (products[best_[i]] < taken) add(best_[i]);
      if (wanted == k_ || shortlist.limit() != Shortlist::kNoLimit) return;
      taken = limit;
    }
  }

  [[nodiscard]] static bool is_present(const Source& source, std::size_t entry) {
    const Segment::Lists& lists = source.part->segment->lists(source.sign);
    return source.part->numbers[lists.entries[entry].unit].present;
  }

  [[nodiscard]] int group_of(const Source& source, std::size_t entry) const {
    const Segment::Lists& lists = source.part->segment->lists(source.sign);
    return group_of(source.part->numbers[lists.entries[entry].unit].view);
  }
  [[nodiscard]] int group_of(int view) const {
    return view < 0 ? -1 : (*groups_)[static_cast<std::size_t>(view)];
  }

  /// Where the descriptor of a candidate is.
  struct Candidate {
    const uchar* row;
    bool half;  ///< CV_16F, else CV_32F
    int view, feature;
  };

  /// Fixes the candidates of a query and asks for their entries.
  void choose(std::size_t q) {
    Shortlist& shortlist = shortlists_[q];
    shortlist.tighten();
    std::size_t s = 0;
    for (std::size_t i = 0; i < shortlist.size(); ++i) {
      s = source_of(shortlist.place(i), s);
      __builtin_prefetch(entries_of(sources_[s]) + (shortlist.place(i) - sources_[s].first_place));
    }
  }

  /// Asks for the rows of the candidates of a query. The k best by their codes come first.
  void locate(std::size_t q) {
    const Shortlist& shortlist = shortlists_[q];
    std::vector<Candidate>& candidates = located_[q % located_.size()];
    candidates.clear();
    std::size_t s = 0;
    for (std::size_t i = 0; i < shortlist.size(); ++i) {
      s = source_of(shortlist.place(i), s);
      candidates.push_back(candidate(sources_[s], shortlist.place(i)));
    }
  }

  /// The source of a place; a guess saves the search.
  [[nodiscard]] std::size_t source_of(std::uint32_t place, std::size_t guess) const {
    while (sources_[guess].first_place > place) --guess;
    while (guess + 1 < sources_.size() && sources_[guess + 1].first_place <= place) ++guess;
    return guess;
  }

  [[nodiscard]] static const Segment::Entry* entries_of(const Source& source) {
    return source.part->segment->lists(source.sign).entries.data();
  }

  [[nodiscard]] static Candidate candidate(const Source& source, std::uint32_t place) {
    const Segment::Entry entry = entries_of(source)[place - source.first_place];
    const ListIndex::Number& number = source.part->numbers[entry.unit];
    const cv::Mat& rows = source.part->segment->units()[entry.unit].descriptors;
    const uchar* row = rows.data + rows.step.p[0] * entry.feature;
    const std::size_t bytes = rows.elemSize() * static_cast<std::size_t>(rows.cols);
    for (std::size_t offset = 0; offset < bytes; offset += 64) __builtin_prefetch(row + offset);
    return {row, rows.depth() == CV_16F, number.view,
            number.first + static_cast<int>(entry.feature)};
  }

  /// The k best of the candidates of a query by exact distance, with groups up to the first of
  /// another one.
  void rank(std::size_t q, NeighborLists& result) {
    std::vector<Candidate>& candidates = located_[q % located_.size()];
    const std::size_t wanted = std::min(k_, candidates.size());
    measure(q, candidates);
    Neighbor* sorted = result.fill(begin_ + q, wanted);
    sort(sorted, wanted);
    if (!groups_ || wanted == 0) return;
    const auto rival = std::find_if(sorted, sorted + wanted,
                                    [&, first = group_of(sorted->view)](const Neighbor& n) {
                                      return group_of(n.view) != first;
                                    });
    if (rival != sorted + wanted)
      result.shorten(begin_ + q, static_cast<std::size_t>(rival + 1 - sorted));
  }

  /// The first `wanted` of `ranked_` in order. Few are sorted by counting, for each, how many are
  /// nearer: no branch is guessed wrong.
  void sort(Neighbor* sorted, std::size_t wanted) {
    constexpr std::size_t kFew = 64;
    const std::size_t size = ranked_.size();
    bool unequal = size <= kFew;
    std::array<bool, kFew> taken{};
    for (std::size_t i = 0; i < size && unequal; ++i) {
      std::uint32_t nearer = 0;
      for (std::size_t j = 0; j < size; ++j) nearer += distances_[j] < distances_[i] ? 1U : 0U;
      unequal = !taken[nearer];
      taken[nearer] = true;
      if (nearer < wanted) sorted[nearer] = ranked_[i];
    }
    if (!unequal)
      std::partial_sort_copy(ranked_.begin(), ranked_.end(), sorted, sorted + wanted, before);
  }

  void measure(std::size_t q, const std::vector<Candidate>& candidates) {
    const std::size_t count = candidates.size();
    const auto size = static_cast<std::size_t>(coder_.dimension());
    rows_.resize(count);
    distances_.resize(count);
    floats_.resize(count * size);
    ranked_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      rows_[i] = reinterpret_cast<const float*>(candidates[i].row);
      if (!candidates[i].half) continue;
      cv::hal::cvt16f32f(reinterpret_cast<const cv::float16_t*>(candidates[i].row),
                         &floats_[i * size], coder_.dimension());
      rows_[i] = &floats_[i * size];
    }
    distances(row(q), rows_.data(), count, size, distances_.data());
    for (std::size_t i = 0; i < count; ++i)
      ranked_.push_back({candidates[i].view, candidates[i].feature, distances_[i]});
  }

  const ListIndex& index_;
  const Coder& coder_;
  const Features& scene_;
  std::size_t k_;
  const std::vector<int>* groups_;  ///< null: all k are wanted
  std::size_t begin_ = 0, count_ = 0;
  bool certain_;
  std::size_t code_bytes_, capacity_;
  float residual_ = 0;
  std::vector<Source> sources_;
  std::vector<std::int8_t> codes_;
  std::vector<Query> queries_;
  std::vector<Shortlist> shortlists_;
  std::vector<std::int16_t> keys_;     ///< lent to the shortlists
  std::vector<std::uint32_t> places_;  ///< lent to the shortlists
  std::vector<std::uint32_t> seekers_, ends_;
  std::vector<Centers::Probe> probes_;
  Centers::Buffer buffer_;
  std::vector<Visit> visits_;
  std::array<ScanQuery, kMaxQueries> scans_;
  std::array<Visit, kMaxQueries> scanned_;
  std::array<std::uint16_t, kMaxQueries * kChunkBlocks> found_;
  std::vector<std::uint32_t> best_;
  std::array<std::int16_t, kMaxQueries * kChunk> products_;
  std::array<std::vector<Candidate>, kAhead + 1> located_;
  std::vector<const float*> rows_;
  std::vector<float> distances_;  ///< of `ranked_`
  std::vector<float> floats_;
  std::vector<Neighbor> ranked_;
};

}  // namespace

void search_rows(const ListIndex& index, const Features& scene, std::size_t k,
                 const std::vector<int>* groups, std::size_t begin, std::size_t end,
                 NeighborLists& result) {
  if (begin == end) return;
  const auto search = std::make_unique<Search>(index, scene, k, groups);
  for (std::size_t first = begin; first < end; first += kBatch)
    search->run(first, std::min(end, first + kBatch), result);
}

}  // namespace posevote
