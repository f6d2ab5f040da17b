#include "posevote/recognize/resemblance.hpp"

#include <algorithm>

namespace posevote {

std::vector<Resemblance> find_resemblances(const std::string& name,
                                           const std::vector<std::shared_ptr<const View>>& views,
                                           const ModelSet& models, const FeatureOptions& features) {
  std::vector<ObjectModel> others;
  for (const ObjectModel& object : models.objects())
    if (object.name != name && !object.views.empty()) others.push_back(object);
  if (others.empty()) return {};
  RecognizeOptions options;
  options.feature = features;
  options.verify.false_alarms_per_1000_images = 1e6;  // a shared part is enough
  const Recognizer recognizer(
      std::make_shared<ModelSet>(models.signature(), std::move(others), models.impostors()),
      options);
  std::vector<Resemblance> found;
  for (const auto& view : views)
    for (const Detection& detection :
         recognizer.recognize(view->features, view->picture).detections) {
      auto known = std::ranges::find(found, detection.object, &Resemblance::object);
      if (known == found.end()) known = found.insert(found.end(), {detection.object, 0});
      known->features = std::max(known->features, detection.inliers);
    }
  std::ranges::stable_sort(found, std::ranges::greater(), &Resemblance::features);
  return found;
}

}  // namespace posevote
