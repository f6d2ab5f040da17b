// Everything that recognition went through in one picture.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posevote/recognize/recognizer.hpp"

namespace posevote {

struct TracedHypothesis {
  Detection detection;
  HypothesisStage stage = HypothesisStage::pose;
  std::string reason;  ///< why it was refused; "" when it was accepted
};

struct Trace {
  std::shared_ptr<const ModelSet> models;
  Features scene;
  std::vector<std::vector<int>> similar_views;  ///< by scene feature: the views of its neighbours
  std::vector<Match> matches;                   ///< those that passed the ratio
  std::vector<PoseCluster> clusters;
  std::vector<TracedHypothesis> hypotheses;  ///< before they compete; none under the paper's rule
  std::vector<Detection> detections;
};

}  // namespace posevote
