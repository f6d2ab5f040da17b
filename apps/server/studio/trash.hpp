// What was deleted or merged and may come back.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "posevote/store/object_store.hpp"

namespace posevote::server {

struct Deletion {
  std::string id;      ///< to undo it by
  std::string object;  ///< that was deleted, or of which a view was
  std::string view;    ///< "": all of them
  std::string into;    ///< the object that it was merged into; "": none
  double age_s = 0;
};

/// Keeps each deletion as a small database in a folder, for a time. Safe for many threads.
class Trash {
 public:
  /// `keep_s`: how long. What an earlier run left counts from when it was deleted.
  Trash(std::string folder, double keep_s);

  /// Each deletes as one change of `store` and returns the id to undo it by. Throws
  /// Error{not_found}.
  [[nodiscard]] std::string delete_object(ObjectStore& store, const std::string& object);
  [[nodiscard]] std::string delete_view(ObjectStore& store, const std::string& object,
                                        const std::string& view);
  /// Moves all views. Throws Problem 400 when both are the same.
  [[nodiscard]] std::string merge(ObjectStore& store, const std::string& object,
                                  const std::string& into);

  /// Returns the name of the object that came back. Throws Problem 404 when there is nothing of
  /// that id any more, Error{already_exists} when the name was given to another object meanwhile.
  std::string undo(ObjectStore& store, const std::string& id);

  /// What can be undone, newest first.
  [[nodiscard]] std::vector<Deletion> list() const;

  /// Forgets what is too old.
  void expire();

 private:
  [[nodiscard]] std::string path(const std::string& id) const { return folder_ + "/" + id; }
  std::string keep(const ObjectStore& store, const std::string& object, const std::string& view,
                   const std::string& into) const;
  [[nodiscard]] Deletion note(const std::string& id) const;  ///< throws Problem 404
  void forget(const std::string& id) const;

  std::string folder_;
  double keep_s_;
  mutable std::mutex mutex_;
};

}  // namespace posevote::server
