#include "quality_cards.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "posevote/evaluate/table.hpp"
#include "posevote/recognize/resemblance.hpp"

namespace posevote::cli {
namespace {

std::string pixels(double value) {
  return std::isnan(value) ? "?" : std::to_string(std::lround(value)) + " px";
}

}  // namespace

void print_quality(const std::vector<std::shared_ptr<const View>>& views,
                   const std::vector<std::shared_ptr<const View>>& all,
                   const QualityOptions& options, std::ostream& out) {
  Table table;
  table.header = {"view",       "features",       "spread over",
                  "found from", "repeats itself", "known already"};
  std::vector<std::pair<std::string, std::vector<std::string>>> advice;  // a sentence, the views
  for (const auto& view : views) {
    std::vector<std::shared_ptr<const View>> others;
    std::ranges::copy_if(all, std::back_inserter(others),
                         [&](const auto& other) { return other->id != view->id; });
    const ViewQuality quality = assess_view(*view, others, options);
    table.rows.push_back({view->id, std::to_string(quality.features), percent(quality.coverage, 0),
                          pixels(quality.smallest_size_px), percent(quality.self_similarity, 0),
                          percent(quality.redundancy, 0)});
    for (const std::string& sentence : quality.advice) {
      auto known = std::ranges::find(advice, sentence, [](const auto& said) { return said.first; });
      if (known == advice.end()) known = advice.insert(known, {sentence, {}});
      known->second.push_back(view->id);
    }
  }
  out << table.to_text();
  for (const auto& [sentence, of] : advice) {
    out << sentence;
    if (of.size() < views.size()) out << " (view";
    for (const std::string& view : of)
      if (of.size() < views.size()) out << ' ' << view;
    out << (of.size() < views.size() ? ")\n" : "\n");
  }
}

void print_resemblances(const std::string& name,
                        const std::vector<std::shared_ptr<const View>>& views,
                        const ModelSet& models, const FeatureOptions& features, std::ostream& out) {
  for (const Resemblance& other : find_resemblances(name, views, models, features))
    out << name << " looks like " << other.object << ": " << other.features
        << " shared features; what differs will decide between the two\n";
}

}  // namespace posevote::cli
