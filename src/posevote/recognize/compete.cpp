#include "posevote/recognize/compete.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace posevote {
namespace {

int object_of(const Hypothesis& hypothesis, const SceneContext& scene) {
  return scene.models.views()[static_cast<std::size_t>(hypothesis.view)].object;
}

cv::Rect2f box_of(const Hypothesis& hypothesis, const SceneContext& scene) {
  const View& view = *scene.models.views()[static_cast<std::size_t>(hypothesis.view)].view;
  return cv::boundingRect(transform_polygon(hypothesis.scene_from_view, view.outline));
}

double overlap(const cv::Rect2f& a, const cv::Rect2f& b) {
  const double common = (a & b).area();
  const double all = a.area() + b.area() - common;
  return all > 0 ? common / all : 0;
}

void take_features(const Hypothesis& hypothesis, std::vector<char>& taken) {
  for (const Match& match : hypothesis.evidence.inliers)
    taken[static_cast<std::size_t>(match.scene)] = 1;
}

bool uses_taken(const Hypothesis& hypothesis, const std::vector<char>& taken) {
  return std::ranges::any_of(hypothesis.evidence.inliers, [&](const Match& match) {
    return taken[static_cast<std::size_t>(match.scene)] != 0;
  });
}

}  // namespace

std::vector<Hypothesis> compete(std::vector<Hypothesis> hypotheses, const SceneContext& scene,
                                const RecognizeOptions& options) {
  std::erase_if(hypotheses, [](const Hypothesis& h) { return !h.rejected.empty(); });
  std::ranges::stable_sort(hypotheses, {}, &Hypothesis::log10_false_alarms);
  std::vector<char> taken(scene.grid.features().size(), 0);
  std::vector<Hypothesis> kept;
  for (Hypothesis& hypothesis : hypotheses) {
    const bool known = std::ranges::any_of(kept, [&](const Hypothesis& other) {
      return object_of(other, scene) == object_of(hypothesis, scene) &&
             overlap(box_of(other, scene), box_of(hypothesis, scene)) > options.max_overlap;
    });
    if (known) continue;
    if (uses_taken(hypothesis, taken)) reconsider(hypothesis, scene, taken, options.verify);
    if (!hypothesis.rejected.empty()) continue;
    take_features(hypothesis, taken);
    kept.push_back(std::move(hypothesis));
  }
  return kept;
}

}  // namespace posevote
