#include "posevote/recognize/consensus.hpp"

#include <opencv2/imgproc.hpp>

#include "posevote/recognize/overlap.hpp"

namespace posevote {
namespace {

constexpr double kSamePlace = 0.2;

struct Placed {
  Hypothesis* hypothesis;
  int object;
  cv::Rect2f box;
};

}  // namespace

void measure_consensus(std::vector<Hypothesis>& hypotheses, const ModelSet& models) {
  std::vector<Placed> placed;
  for (Hypothesis& hypothesis : hypotheses) {
    if (!hypothesis.rejected.empty()) continue;
    const auto& entry = models.views()[static_cast<std::size_t>(hypothesis.view)];
    placed.push_back(
        {&hypothesis, entry.object,
         cv::boundingRect(transform_polygon(hypothesis.scene_from_view, entry.view->outline))});
  }
  for (const Placed& one : placed) {
    double weights = 0, sum = 0;
    for (const Placed& other : placed) {
      if (other.object != one.object || other.hypothesis->view == one.hypothesis->view) continue;
      const double common = overlap(one.box, other.box);
      if (common <= kSamePlace) continue;
      const auto weight = static_cast<double>(other.hypothesis->evidence.inliers.size());
      weights += weight;
      sum += weight * common;
    }
    one.hypothesis->measured.consensus = weights > 0 ? sum / weights : -1;
  }
}

}  // namespace posevote
