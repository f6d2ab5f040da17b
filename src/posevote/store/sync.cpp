#include "posevote/store/sync.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

constexpr const char* note_key = "sync ";

void require_same_features(const ObjectStore& a, const ObjectStore& b) {
  const auto of_a = a.features(), of_b = b.features();
  if (of_a && of_b && of_a->signature != of_b->signature)
    throw Error(ErrorCode::feature_mismatch,
                "'" + a.location() + "' holds features '" + of_a->signature + "' and '" +
                    b.location() + "' holds '" + of_b->signature +
                    "'; convert one of them: posevote objects rebuild");
}

/// One picture that has different names on the two sides, where neither side knows the other's.
void find_two_names(const std::vector<KnownView>& only_a, const std::vector<KnownView>& only_b,
                    std::vector<Conflict>& conflicts) {
  std::map<std::string, std::string> names;
  for (const KnownView& view : only_a)
    if (!view.key.object.empty()) names[view.key.identity] = view.key.object;
  for (const KnownView& view : only_b)
    if (const auto found = names.find(view.key.identity);
        found != names.end() && !view.key.object.empty())
      conflicts.push_back(
          {ConflictKind::two_names, found->second, view.key.object, view.key.identity});
}

void copy_view(const ObjectStore& from, const KnownView& view, ObjectStore& to,
               const FeatureRecord& features) {
  if (view.key.object.empty())
    to.add_impostor(from.impostor(view.id), features);
  else
    to.add_view(view.key.object, from.view(view.key.object, view.id), features);
}

void remove_view(ObjectStore& store, const KnownView& view) {
  if (view.key.object.empty())
    store.remove_impostor(view.id);
  else
    store.remove_view(view.key.object, view.id);
}

/// Does `step`; what somebody else has removed meanwhile needs no further work.
template <class Step>
void unless_gone(Step step) {
  try {
    step();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::not_found) throw;
  }
}

std::set<ViewKey> read_note(const std::string& text) {
  std::set<ViewKey> keys;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t space = line.find(' '); space != std::string::npos)
      keys.insert({line.substr(space + 1), line.substr(0, space)});
  return keys;
}

std::string write_note(const std::set<ViewKey>& keys) {
  std::string text;
  for (const ViewKey& key : keys) text += key.identity + " " + key.object + "\n";
  return text;
}

}  // namespace

std::string to_string(const Conflict& conflict) {
  if (conflict.kind == ConflictKind::two_names)
    return "one picture is taught as '" + conflict.object + "' and as '" + conflict.other_object +
           "'; rename or remove one of them";
  return "a view of '" + conflict.object +
         "' is not the same on both sides although its picture is; remove one of them, or make the "
         "features again: posevote objects rebuild";
}

std::vector<KnownView> list_views(const ObjectStore& store) {
  std::vector<KnownView> all;
  for (const ObjectSummary& object : store.list()) {
    std::vector<ViewSummary> views;
    unless_gone([&] { views = store.views(object.name); });
    for (const ViewSummary& view : views)
      all.push_back({{object.name, view.identity}, view.id, view.hash, view.provenance});
  }
  for (const ImpostorSummary& impostor : store.impostors())
    all.push_back({{"", impostor.identity}, impostor.id, "", impostor.provenance});
  std::ranges::sort(all, std::less<>(), &KnownView::key);
  return all;
}

Difference compare_views(const std::vector<KnownView>& a, const std::vector<KnownView>& b) {
  Difference difference;
  auto in_a = a.begin();
  auto in_b = b.begin();
  while (in_a != a.end() || in_b != b.end()) {
    if (in_b == b.end() || (in_a != a.end() && in_a->key < in_b->key)) {
      difference.only_a.push_back(*in_a++);
    } else if (in_a == a.end() || in_b->key < in_a->key) {
      difference.only_b.push_back(*in_b++);
    } else {
      ++difference.in_both;
      const ViewKey& key = in_a->key;
      if (in_a->hash != in_b->hash)
        difference.conflicts.push_back(
            {ConflictKind::other_features, key.object, key.object, key.identity});
      ++in_a, ++in_b;
    }
  }
  find_two_names(difference.only_a, difference.only_b, difference.conflicts);
  return difference;
}

MergeReport merge_objects(const ObjectStore& from, ObjectStore& to) {
  require_same_features(from, to);
  const auto features = from.features();
  const Difference difference = compare_views(list_views(from), list_views(to));
  MergeReport report;
  report.known = difference.in_both;
  report.conflicts = difference.conflicts;
  for (const KnownView& view : difference.only_a)
    unless_gone([&] {
      copy_view(from, view, to, features.value());
      report.added.push_back(view);
    });
  return report;
}

SyncPlan plan_sync(const std::vector<KnownView>& here, const std::vector<KnownView>& there,
                   const std::set<ViewKey>& last, const SyncOptions& options) {
  const Difference difference = compare_views(here, there);
  SyncPlan plan;
  plan.in_both = difference.in_both;
  const auto was_in_both = [&](const KnownView& view) {
    return options.removals && last.contains(view.key);
  };
  for (const KnownView& view : difference.only_a)
    (was_in_both(view) ? plan.remove_here : plan.send).push_back(view);
  for (const KnownView& view : difference.only_b)
    (was_in_both(view) ? plan.remove_there : plan.receive).push_back(view);
  for (const Conflict& conflict : difference.conflicts)
    if (conflict.kind != ConflictKind::two_names) plan.conflicts.push_back(conflict);
  find_two_names(plan.send, plan.receive, plan.conflicts);  // not what one side has renamed
  return plan;
}

SyncReport sync_objects(ObjectStore& here, ObjectStore& there, const SyncOptions& options) {
  require_same_features(here, there);
  const std::string key = note_key + there.location();
  const std::set<ViewKey> last = read_note(here.note(key));
  const auto views_here = list_views(here), views_there = list_views(there);
  const SyncPlan plan = plan_sync(views_here, views_there, last, options);
  const auto features_here = here.features(), features_there = there.features();

  SyncReport report;
  report.in_both = plan.in_both;
  report.conflicts = plan.conflicts;
  std::set<ViewKey> both;  // what the two have in common afterwards
  for (const KnownView& view : views_here)
    if (std::ranges::binary_search(views_there, view.key, std::less<>(), &KnownView::key))
      both.insert(view.key);

  // Additions come first: whatever happens then, a renamed object is in one place at least.
  for (const KnownView& view : plan.receive)
    unless_gone([&] {
      copy_view(there, view, here, features_there.value());
      report.received.push_back(view);
      both.insert(view.key);
    });
  const bool may_send = plan.send.empty() || !there.read_only();
  for (const KnownView& view : plan.send) {
    if (!may_send) {
      report.not_sent.push_back(view);
      continue;
    }
    unless_gone([&] {
      copy_view(here, view, there, features_here.value());
      report.sent.push_back(view);
      both.insert(view.key);
    });
  }
  for (const KnownView& view : plan.remove_here) {
    unless_gone([&] { remove_view(here, view); });
    report.removed_here.push_back(view);
  }
  const bool may_remove = plan.remove_there.empty() || there.may_remove();
  for (const KnownView& view : plan.remove_there) {
    if (may_remove) unless_gone([&] { remove_view(there, view); });
    (may_remove ? report.removed_there : report.not_removed_there).push_back(view);
    if (!may_remove) both.insert(view.key);  // so that it is not received again
  }
  if (both != last) here.set_note(key, write_note(both));
  return report;
}

}  // namespace posevote
