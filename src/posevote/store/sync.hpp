// What two databases know of each other's objects: differences, merging, and keeping two of them
// the same although each is changed while the other cannot be reached.
//
// A view is the same in both when it belongs to an object of the same name and was taught from the
// same picture with the same mask and yaw: its identity.
#pragma once

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "posevote/store/object_store.hpp"

namespace posevote {

/// A view, or an impostor: then `object` is "".
struct ViewKey {
  std::string object, identity;
  friend bool operator==(const ViewKey& a, const ViewKey& b) {
    return a.object == b.object && a.identity == b.identity;
  }
  friend bool operator<(const ViewKey& a, const ViewKey& b) {
    return std::tie(a.object, a.identity) < std::tie(b.object, b.identity);
  }
};

struct KnownView {
  ViewKey key;
  std::string id;    ///< in the database that it is in
  std::string hash;  ///< ViewSummary::hash; "" of impostors
  Provenance provenance;
};

enum class ConflictKind {
  other_features,  ///< taught from the same picture, but its features or outline are not the same
  two_names,       ///< one picture is taught as two objects
};

/// What needs a decision; nothing is changed because of it.
struct Conflict {
  ConflictKind kind;
  std::string object, other_object;  ///< equal unless two names
  std::string identity;
};

[[nodiscard]] std::string to_string(const Conflict& conflict);

/// All views and impostors, by key.
[[nodiscard]] std::vector<KnownView> list_views(const ObjectStore& store);

struct Difference {
  std::vector<KnownView> only_a, only_b;
  std::size_t in_both = 0;
  std::vector<Conflict> conflicts;
};

[[nodiscard]] Difference compare_views(const std::vector<KnownView>& a,
                                       const std::vector<KnownView>& b);

struct MergeReport {
  std::vector<KnownView> added;
  std::size_t known = 0;  ///< views that were there already
  std::vector<Conflict> conflicts;
};

/// Adds to `to` what only `from` has; removes nothing. Each view is a change of its own: after an
/// error or a kill, merging again does the rest. Throws Error{feature_mismatch} before anything is
/// changed when the two hold different features.
MergeReport merge_objects(const ObjectStore& from, ObjectStore& to);

struct SyncOptions {
  bool removals = true;  ///< also remove what was removed on the other side; false: only add
};

struct SyncReport {
  std::vector<KnownView> sent, received;
  std::vector<KnownView> removed_here, removed_there;
  /// What the user of `there` has no right to add or to remove there; tried again next time.
  std::vector<KnownView> not_sent, not_removed_there;
  std::size_t in_both = 0;  ///< that nothing had to be done about
  std::vector<Conflict> conflicts;
};

/// Makes both the same. What only one side has is copied to the other, unless both had it when they
/// were last synchronised: then it was removed since, and is removed here, too. (A renamed object
/// is one that was removed and added.) Without a last time everything is copied and nothing
/// removed. Afterwards `here` notes what both have.
///
/// Every step is a change of its own and the note comes last: after an error or a kill at any
/// moment, doing it again does the rest; nothing is lost, nothing is there twice. Throws as
/// `merge_objects`.
SyncReport sync_objects(ObjectStore& here, ObjectStore& there, const SyncOptions& options = {});

/// What `sync_objects` would do, given what both had the last time.
struct SyncPlan {
  std::vector<KnownView> send, receive, remove_here, remove_there;
  std::size_t in_both = 0;
  std::vector<Conflict> conflicts;
};

[[nodiscard]] SyncPlan plan_sync(const std::vector<KnownView>& here,
                                 const std::vector<KnownView>& there, const std::set<ViewKey>& last,
                                 const SyncOptions& options = {});

}  // namespace posevote
