#include "posevote/index/index.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "posevote/core/error.hpp"
#include "posevote/index/list_index.hpp"

namespace posevote {
namespace {

using Number = ListIndex::Number;
using Part = ListIndex::Part;

/// Rows per list that k-means looks at.
constexpr std::size_t kSamplesPerList = 40;
/// Lists for n descriptors: this times the root of n.
constexpr double kListsPerRoot = 3;
/// Lists are learnt again when this many times more or fewer would be chosen now. Their number
/// grows with the root of the number of descriptors, and the time of a search is flat about its
/// minimum.
constexpr std::size_t kListsMisfit = 4;

struct NumberedUnit {
  Unit unit;
  Number number;
};

Unit make_unit(const Features& features, std::shared_ptr<const View> view) {
  Unit unit;
  unit.view = std::move(view);
  unit.descriptors = features.descriptors;
  for (const Keypoint& keypoint : features.keypoints) unit.signs.push_back(keypoint.laplacian);
  return unit;
}

/// All features of the models that can be found. Throws when they cannot be compared.
std::vector<NumberedUnit> units_of(const ModelSet& models) {
  std::vector<NumberedUnit> units;
  const auto add = [&](const Features& features, std::shared_ptr<const View> view, Number number) {
    if (features.empty()) return;
    units.push_back({make_unit(features, std::move(view)), number});
    const cv::Mat& rows = features.descriptors;
    if (rows.rows != static_cast<int>(features.size()) ||
        rows.cols != units.front().unit.descriptors.cols ||
        (rows.type() != CV_32F && rows.type() != CV_16F))
      throw Error(ErrorCode::feature_mismatch,
                  "features with descriptors of different length or type cannot be in one index");
  };
  for (std::size_t v = 0; v < models.views().size(); ++v)
    add(models.views()[v].view->features, models.views()[v].view, {true, static_cast<int>(v), 0});
  int counted = 0;
  for (const Features& features : models.impostors()) {
    add(features, nullptr, {true, -1, counted});
    counted += static_cast<int>(features.size());
  }
  return units;
}

std::array<std::size_t, kSigns> count_signs(const std::vector<NumberedUnit>& units) {
  std::array<std::size_t, kSigns> counts{};
  for (const auto& [unit, number] : units)
    for (const std::int8_t sign : unit.signs) ++counts[sign_class(sign)];
  return counts;
}

/// How many lists suit `count` descriptors; 0: scan them all.
std::size_t suitable_lists(std::size_t count, const IndexOptions& options) {
  if (options.method == "exact") return 0;
  if (options.method == "auto" && count <= static_cast<std::size_t>(options.scan_limit)) return 0;
  const auto lists =
      static_cast<std::size_t>(kListsPerRoot * std::sqrt(static_cast<double>(count)));
  return std::min<std::size_t>(lists, 65536) / kBlockLanes * kBlockLanes;
}

bool suits(const Quantizer& quantizer, const std::vector<NumberedUnit>& units,
           const IndexOptions& options) {
  const auto counts = count_signs(units);
  for (std::size_t sign = 0; sign < kSigns; ++sign) {
    const std::size_t best = suitable_lists(counts[sign], options);
    const std::size_t present = quantizer[sign].count();
    if (options.method == "exact" && present > 0) return false;
    if (best > kListsMisfit * present || present > kListsMisfit * std::max(best, kBlockLanes))
      return false;
  }
  return true;
}

std::shared_ptr<const Quantizer> train(const Coder& coder, const std::vector<NumberedUnit>& units,
                                       const IndexOptions& options) {
  const auto counts = count_signs(units);
  auto quantizer = std::make_shared<Quantizer>();
  for (std::size_t sign = 0; sign < kSigns; ++sign) {
    const std::size_t lists = suitable_lists(counts[sign], options);
    if (lists == 0) continue;
    const std::size_t stride = std::max<std::size_t>(1, counts[sign] / (lists * kSamplesPerList));
    std::vector<std::pair<const cv::Mat*, int>> sample;
    std::size_t seen = 0;
    for (const auto& [unit, number] : units)
      for (std::size_t i = 0; i < unit.size(); ++i)
        if (sign_class(unit.signs[i]) == sign && seen++ % stride == 0)
          sample.emplace_back(&unit.descriptors, static_cast<int>(i));
    (*quantizer)[sign] = Centers::train(
        coder, lists, sample.size(),
        [&](std::size_t i, std::vector<float>& buffer) {
          return read_row(*sample[i].first, sample[i].second, buffer);
        },
        options.threads);
  }
  return quantizer;
}

/// Takes the units that `previous` has prepared already out of `units`. Segments of which most is
/// still wanted are shared; what is wanted of the others goes back with its lists.
std::vector<Part> reuse(const ListIndex& previous, std::vector<NumberedUnit>& units) {
  std::unordered_multimap<const void*, std::size_t> wanted;
  for (std::size_t i = 0; i < units.size(); ++i) wanted.emplace(units[i].unit.identity(), i);
  std::vector<bool> taken(units.size());
  std::vector<Part> parts;
  for (const Part& old : previous.parts()) {
    const std::vector<Unit>& present = old.segment->units();
    std::vector<std::size_t> match(present.size(), units.size());
    std::size_t alive = 0;
    for (std::size_t u = 0; u < present.size(); ++u) {
      const auto found = wanted.find(present[u].identity());
      if (found == wanted.end()) continue;
      match[u] = found->second;
      wanted.erase(found);
      alive += present[u].size();
    }
    const bool keep = 2 * alive > old.segment->size();
    if (keep) parts.push_back({old.segment, std::vector<Number>(present.size())});
    for (std::size_t u = 0; u < present.size(); ++u) {
      if (match[u] == units.size()) continue;
      if (keep) parts.back().numbers[u] = units[match[u]].number;
      if (keep) taken[match[u]] = true;
      if (!keep) units[match[u]].unit.lists = present[u].lists;
    }
  }
  std::vector<NumberedUnit> rest;
  for (std::size_t i = 0; i < units.size(); ++i)
    if (!taken[i]) rest.push_back(std::move(units[i]));
  units = std::move(rest);
  return parts;
}

Part prepare(const Coder& coder, const Quantizer& quantizer, std::vector<NumberedUnit> units,
             int threads) {
  std::vector<Unit> bare;
  std::vector<Number> numbers;
  for (NumberedUnit& one : units) {
    bare.push_back(std::move(one.unit));
    numbers.push_back(one.number);
  }
  assign_lists(coder, quantizer, bare, threads);
  return {std::make_shared<Segment>(coder, quantizer, std::move(bare)), std::move(numbers)};
}

/// Joins the last parts until each is at least twice as large as the next, so that there are few
/// and a descriptor is copied rarely.
void join_small(const Coder& coder, const Quantizer& quantizer, std::vector<Part>& parts) {
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.segment->size() > b.segment->size();
  });
  while (parts.size() > 1) {
    const std::size_t last = parts.size() - 1;
    if (parts[last - 1].segment->size() >= 2 * parts[last].segment->size()) break;
    std::vector<NumberedUnit> units;
    for (std::size_t p = last - 1; p <= last; ++p)
      for (std::size_t u = 0; u < parts[p].numbers.size(); ++u)
        if (parts[p].numbers[u].present)
          units.push_back({parts[p].segment->units()[u], parts[p].numbers[u]});
    parts.resize(last - 1);
    parts.push_back(prepare(coder, quantizer, std::move(units), 1));
  }
}

/// Is there a list for every feature, and does it exist?
bool has_lists(const Unit& unit, const Quantizer& quantizer) {
  if (unit.lists.size() != unit.size()) return false;
  for (std::size_t i = 0; i < unit.size(); ++i)
    if (unit.lists[i] >= quantizer[sign_class(unit.signs[i])].lists()) return false;
  return true;
}

std::shared_ptr<const Index> build(const ModelSet& models, const IndexOptions& options,
                                   const ListIndex* previous, const std::string& saved_bytes) {
  validate_options(options);
  std::vector<NumberedUnit> units = units_of(models);
  if (units.empty()) return std::make_shared<ListIndex>();
  const Coder coder(units.front().unit.descriptors.cols);
  std::shared_ptr<const Quantizer> quantizer;
  std::vector<Part> parts;
  if (previous && previous->quantizer() && previous->coder().dimension() == coder.dimension() &&
      suits(*previous->quantizer(), units, options)) {
    quantizer = previous->quantizer();
    parts = reuse(*previous, units);
  } else if (!saved_bytes.empty()) {
    SavedLists saved = read_saved(saved_bytes, models.signature(), coder);
    if (saved.quantizer && suits(*saved.quantizer, units, options)) {
      quantizer = saved.quantizer;
      for (auto& [unit, number] : units) {
        const auto found = saved.units.find(saved_key(unit));
        if (found != saved.units.end()) unit.lists = found->second;
        if (!has_lists(unit, *quantizer)) unit.lists.clear();
      }
    }
  }
  if (!quantizer) quantizer = train(coder, units, options);
  std::size_t assigned = 0;
  for (const auto& [unit, number] : units)
    if (unit.lists.size() != unit.size()) assigned += unit.size();
  if (!units.empty())
    parts.push_back(prepare(coder, *quantizer, std::move(units), options.threads));
  join_small(coder, *quantizer, parts);
  return std::make_shared<ListIndex>(models.signature(), options, coder, quantizer,
                                     std::move(parts), assigned);
}

}  // namespace

void IndexOptions::describe(OptionList& list) {
  list.add("method", method, {"auto", "exact", "approximate"},
           "How neighbours are searched: among all descriptors (exact), in lists of similar ones "
           "(approximate), or by their number (auto).");
  list.add("scan_limit", scan_limit, {0, 100e6}, "",
           "Up to this many descriptors of one Laplacian sign, auto looks at all of them.");
  list.add("probes", probes, {1, 65536}, "",
           "Lists that are looked through for each scene feature: more find more and take longer.");
  list.add("threads", threads, {1, 256}, "",
           "Threads of one search; the answers do not depend on it.");
}

std::shared_ptr<const Index> make_index(const std::shared_ptr<const ModelSet>& models,
                                        const IndexOptions& options, const Index* previous) {
  return build(*models, options, dynamic_cast<const ListIndex*>(previous), {});
}

std::shared_ptr<const Index> load_index(const std::shared_ptr<const ModelSet>& models,
                                        const std::string& saved, const IndexOptions& options) {
  return build(*models, options, nullptr, saved);
}

}  // namespace posevote
