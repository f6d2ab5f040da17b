#include "posevote/recognize/explain.hpp"

#include <algorithm>
#include <set>

#include "posevote/core/error.hpp"
#include "posevote/recognize/trace.hpp"

namespace posevote {
namespace {

int index_of(const ModelSet& models, const std::string& object) {
  const auto& objects = models.objects();
  const auto found = std::ranges::find(objects, object, &ObjectModel::name);
  if (found != objects.end()) return static_cast<int>(found - objects.begin());
  std::vector<std::string> names;
  names.reserve(objects.size());
  for (const ObjectModel& known : objects) names.push_back(known.name);
  const std::string nearest = nearest_word(object, names);
  throw Error(ErrorCode::not_found,
              "no object '" + object + "' was taught" +
                  (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

/// Counts and points of the object among the matches and votes.
void follow_matches(const Trace& trace, int object, Explanation& result) {
  const auto& views = trace.models->views();
  const auto is_own = [&](int view) {
    return view >= 0 && views[static_cast<std::size_t>(view)].object == object;
  };
  result.scene_features = static_cast<int>(trace.scene.size());
  result.similar = static_cast<int>(std::ranges::count_if(
      trace.similar_views, [&](const auto& list) { return std::ranges::any_of(list, is_own); }));
  std::set<int> matched;
  for (const Match& match : trace.matches) {
    if (!is_own(match.view)) continue;
    matched.insert(match.scene);
    const View& view = *views[static_cast<std::size_t>(match.view)].view;
    const Keypoint& s = trace.scene.keypoints[static_cast<std::size_t>(match.scene)];
    const Keypoint& v = view.features.keypoints[static_cast<std::size_t>(match.feature)];
    result.matches.push_back({{v.x, v.y}, {s.x, s.y}});
    result.vote_centres.push_back(vote_of(s, v, view.centre).centre);
  }
  result.matched = static_cast<int>(matched.size());
  for (const PoseCluster& cluster : trace.clusters) {
    if (!is_own(cluster.view)) continue;
    ++result.clusters;
    result.largest_bin = std::max(result.largest_bin, cluster.support);
  }
}

/// The object's hypothesis that came farthest.
const TracedHypothesis* strongest(const Trace& trace, const std::string& object) {
  const TracedHypothesis* best = nullptr;
  for (const TracedHypothesis& hypothesis : trace.hypotheses) {
    if (hypothesis.detection.object != object) continue;
    const auto rank = [](const TracedHypothesis& h) {
      return std::pair(static_cast<int>(h.stage), -h.detection.log10_false_alarms);
    };
    if (!best || rank(hypothesis) > rank(*best)) best = &hypothesis;
  }
  return best;
}

void end_at(Explanation& result, const std::string& stage, const std::string& reason,
            const std::string& option) {
  result.stage = stage;
  result.reason = reason;
  result.option = option;
}

std::string number(int count) {
  return std::to_string(count);
}

void end_at_hypothesis(Explanation& result, const TracedHypothesis& hypothesis) {
  switch (hypothesis.stage) {
    case HypothesisStage::pose:
      return end_at(result, "pose", "its strongest pose is refused: " + hypothesis.reason,
                    "verify.min_inliers");
    case HypothesisStage::chance:
      return end_at(result, "chance", hypothesis.reason, "verify.evidence.tolerance");
    case HypothesisStage::presence: {
      const Presence& presence = hypothesis.detection.presence;
      return end_at(result, presence.object_log_odds < presence.place_log_odds ? "object" : "place",
                    hypothesis.reason, "verify.false_alarms_per_1000_images");
    }
    case HypothesisStage::accepted:
      return end_at(result, "competition",
                    "another object explains the same part of the picture better", "max_overlap");
  }
}

void conclude(const Trace& trace, const RecognizeOptions& options, Explanation& result) {
  const auto detected = std::ranges::find(trace.detections, result.object, &Detection::object);
  if (detected != trace.detections.end()) {
    result.best = *detected;
    result.found = true;
    return end_at(result, "found",
                  number(detected->inliers) + " features and the look of the whole agree",
                  "verify.false_alarms_per_1000_images");
  }
  const TracedHypothesis* hypothesis = strongest(trace, result.object);
  if (hypothesis) result.best = hypothesis->detection;
  if (result.scene_features == 0)
    end_at(result, "features", "nothing in the picture has texture enough for a feature",
           "feature.surf.hessian_threshold");
  else if (result.similar == 0)
    end_at(result, "similar", "no feature of the picture looks like one of the object",
           "match.neighbors");
  else if (result.matched < options.vote.min_votes)
    end_at(result, "ratio",
           number(result.similar) + " features look like the object's, but only " +
               number(result.matched) + " of them look more like it than like anything else",
           "match.max_ratio");
  else if (result.clusters == 0)
    end_at(result, "votes",
           number(result.matched) + " features match, but they vote for poses all over the picture",
           "vote.min_votes");
  else if (hypothesis)
    end_at_hypothesis(result, *hypothesis);
  else
    end_at(result, "pose", "stronger hypotheses of other objects used up the time",
           "max_hypotheses");
}

}  // namespace

Explanation explain(const Recognizer& recognizer, const cv::Mat& image, const std::string& object) {
  static_cast<void>(index_of(*recognizer.models(), object));  // before anything is computed
  return explain(recognizer.trace(image), recognizer.options(), object);
}

Explanation explain(const Trace& trace, const RecognizeOptions& options,
                    const std::string& object) {
  Explanation result;
  result.object = object;
  follow_matches(trace, index_of(*trace.models, object), result);
  conclude(trace, options, result);
  return result;
}

std::vector<std::pair<std::string, std::string>> stages_of(const Explanation& e) {
  std::vector<std::pair<std::string, std::string>> stages{
      {"features of the picture", number(e.scene_features)},
      {"that look like one of the object's", number(e.similar)},
      {"more like it than like anything else", number(e.matched)},
      {"most of them voting for one pose", number(e.largest_bin)},
      {"poses with enough votes", number(e.clusters)}};
  if (!e.best) return stages;
  stages.emplace_back("features that agree on the strongest pose", number(e.best->inliers));
  stages.emplace_back("digits of the number of false alarms",
                      cv::format("%.1f", -e.best->log10_false_alarms));
  if (e.best->probability > 0)
    stages.emplace_back("how probable", cv::format("%.0f %% this object, %.0f %% in this place",
                                                   100 * e.best->presence.object(),
                                                   100 * e.best->presence.place()));
  return stages;
}

}  // namespace posevote
