#include "sync_text.hpp"

#include <iostream>

namespace posevote::cli {

void print_views(const std::string& what, const std::vector<KnownView>& views) {
  for (const KnownView& view : views) {
    const Provenance& from = view.provenance;
    std::cout << what << "  " << (view.key.object.empty() ? "(an impostor)" : view.key.object);
    if (!from.source.empty()) std::cout << ", from " << from.source;
    std::cout << ", taught " << from.taught_at;
    if (!from.version.empty()) std::cout << " by posevote " << from.version;
    std::cout << '\n';
  }
}

Json views_json(const std::vector<KnownView>& views) {
  Json all = Json::array();
  for (const KnownView& view : views)
    all.push_back({{"object", view.key.object},
                   {"view", view.id},
                   {"source", view.provenance.source},
                   {"taught_at", view.provenance.taught_at},
                   {"version", view.provenance.version},
                   {"identity", view.key.identity},
                   {"hash", view.hash}});
  return all;
}

void print_conflicts(const std::vector<Conflict>& conflicts) {
  for (const Conflict& conflict : conflicts)
    std::cout << "conflict  " << to_string(conflict) << '\n';
}

Json conflicts_json(const std::vector<Conflict>& conflicts) {
  Json all = Json::array();
  for (const Conflict& conflict : conflicts)
    all.push_back(
        {{"kind", conflict.kind == ConflictKind::two_names ? "two_names" : "other_features"},
         {"object", conflict.object},
         {"other_object", conflict.other_object},
         {"identity", conflict.identity},
         {"text", to_string(conflict)}});
  return all;
}

}  // namespace posevote::cli
