#include "posevote/model/model_set.hpp"

#include <set>

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

void check_view(const ObjectModel& object, const View& view, int& dimension) {
  const auto fail = [&](const std::string& reason) {
    throw Error(ErrorCode::invalid_argument,
                "view '" + view.id + "' of object '" + object.name + "' " + reason);
  };
  if (view.outline.size() < 3) fail("has no outline");
  const cv::Mat& descriptors = view.features.descriptors;
  if (descriptors.rows != static_cast<int>(view.features.size()))
    fail("has not one descriptor for each key point");
  if (descriptors.empty()) return;
  if (descriptors.type() != CV_32F && descriptors.type() != CV_16F)
    fail("has descriptors that are not floats of 32 or 16 bits");
  if (dimension == 0) dimension = descriptors.cols;
  if (descriptors.cols != dimension) fail("has descriptors of another length than the others");
}

}  // namespace

ModelSet::ModelSet(std::string signature, std::vector<ObjectModel> objects,
                   std::vector<Features> impostors)
    : signature_(std::move(signature)),
      objects_(std::move(objects)),
      impostors_(std::move(impostors)) {
  std::set<std::string> names;
  int dimension = 0;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const ObjectModel& object = objects_[i];
    if (object.name.empty()) throw Error(ErrorCode::invalid_argument, "an object needs a name");
    if (!names.insert(object.name).second)
      throw Error(ErrorCode::invalid_argument, "object '" + object.name + "' is there twice");
    for (const auto& view : object.views) {
      check_view(object, *view, dimension);
      views_.push_back({static_cast<int>(i), view});
      feature_count_ += view->features.size();
    }
  }
}

}  // namespace posevote
