// The immutable snapshot of all objects that recognition reads.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posevote/model/view.hpp"

namespace posevote {

/// Objects with their views, and a pool of features that belong to no object (pictures of the
/// surroundings, false detections marked by the user), all of one feature signature. Immutable
/// after construction, so it is shared between threads without locks; teaching makes a new one that
/// shares the views.
class ModelSet {
 public:
  /// A view and the object it belongs to: index into `objects()`.
  struct Entry {
    int object;
    std::shared_ptr<const View> view;
  };

  ModelSet() = default;
  /// Throws Error{invalid_argument} on two objects of one name, an unnamed object, a view with
  /// descriptors of another length, or a view with fewer than 3 outline points.
  ModelSet(std::string signature, std::vector<ObjectModel> objects,
           std::vector<Features> impostors = {});

  [[nodiscard]] const std::string& signature() const noexcept { return signature_; }
  [[nodiscard]] const std::vector<ObjectModel>& objects() const noexcept { return objects_; }
  /// All views of all objects, object by object: the numbering that matches and votes use.
  [[nodiscard]] const std::vector<Entry>& views() const noexcept { return views_; }
  [[nodiscard]] const std::vector<Features>& impostors() const noexcept { return impostors_; }
  [[nodiscard]] const std::string& name_of_view(int view) const {
    return objects_[static_cast<std::size_t>(views_[static_cast<std::size_t>(view)].object)].name;
  }
  [[nodiscard]] std::size_t feature_count() const noexcept { return feature_count_; }

 private:
  std::string signature_;
  std::vector<ObjectModel> objects_;
  std::vector<Entry> views_;
  std::vector<Features> impostors_;
  std::size_t feature_count_ = 0;
};

}  // namespace posevote
