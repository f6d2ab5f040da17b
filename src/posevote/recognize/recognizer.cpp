#include "posevote/recognize/recognizer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <thread>

#include "posevote/core/error.hpp"
#include "posevote/core/stopwatch.hpp"
#include "posevote/index/parallel.hpp"
#include "posevote/match/look_alikes.hpp"
#include "posevote/recognize/compete.hpp"
#include "posevote/recognize/consensus.hpp"
#include "posevote/recognize/deadline.hpp"
#include "posevote/recognize/prepared.hpp"
#include "posevote/recognize/trace.hpp"
#include "posevote/recognize/unknown.hpp"

namespace posevote {
namespace {

template <class Get, class Items>
int count_distinct(const Items& items, Get&& scene_feature_of) {
  std::set<int> distinct;
  for (const auto& item : items) distinct.insert(scene_feature_of(item));
  return static_cast<int>(distinct.size());
}

int count_clustered(const std::vector<PoseCluster>& clusters, const std::vector<Match>& matches) {
  std::set<int> distinct;
  for (const auto& cluster : clusters)
    for (const int m : cluster.matches) distinct.insert(matches[static_cast<std::size_t>(m)].scene);
  return static_cast<int>(distinct.size());
}

/// Neighbouring bins hold nearly the same matches: a cluster of which most were looked at is
/// skipped.
bool is_repeated(const PoseCluster& cluster, std::vector<char>& seen) {
  const auto known = std::ranges::count_if(
      cluster.matches, [&](int m) { return seen[static_cast<std::size_t>(m)] != 0; });
  for (const int m : cluster.matches) seen[static_cast<std::size_t>(m)] = 1;
  constexpr double kMost = 0.85;
  return static_cast<double>(known) > kMost * static_cast<double>(cluster.matches.size());
}

// Shares of the time budget after which no more features are matched and no more hypotheses
// verified: the one in hand and the competition that follows need the rest.
constexpr double kMatchingEnds = 0.6, kVerifyingEnds = 0.8;

std::vector<const PoseCluster*> choose_clusters(const std::vector<PoseCluster>& clusters,
                                                std::size_t matches, int most) {
  std::vector<const PoseCluster*> chosen;
  std::vector<char> seen(matches, 0);
  for (const PoseCluster& cluster : clusters) {
    if (static_cast<int>(chosen.size()) == most) break;
    if (!is_repeated(cluster, seen)) chosen.push_back(&cluster);
  }
  return chosen;
}

std::vector<Hypothesis> verify_all(const std::vector<PoseCluster>& clusters,
                                   const SceneContext& scene, const RecognizeOptions& options,
                                   const Deadline& deadline, bool& incomplete) {
  const auto chosen = choose_clusters(clusters, scene.matches.size(), options.max_hypotheses);
  std::vector<Hypothesis> found(chosen.size());
  std::atomic<std::size_t> next = 0;
  const auto verify_some = [&](SceneRivals& rivals) {
    const SceneContext own{scene.models, scene.neighborhood, scene.grid, scene.matches,
                           rivals,       scene.pyramid};
    while (!deadline.passed(kVerifyingEnds)) {
      const std::size_t i = next++;
      if (i >= chosen.size()) break;
      found[i] = verify_cluster(*chosen[i], own, options.verify);
    }
  };
  const auto threads = std::min(chosen.size(), static_cast<std::size_t>(options.threads));
  parallel(static_cast<int>(threads), threads, [&](std::size_t begin, std::size_t) {
    if (begin == 0) return verify_some(scene.rivals);
    SceneRivals rivals(scene.models, scene.grid.features(), options.verify.evidence.rivals);
    verify_some(rivals);
  });
  const std::size_t done = std::min(next.load(), chosen.size());  // all before it are, too
  incomplete = incomplete || done < chosen.size();
  found.resize(done);
  return found;
}

/// Throws as `validate_options`.
RecognizeOptions completed(RecognizeOptions options) {
  validate_options(options);
  if (options.threads == 0)
    options.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
  if (options.threads > 1) options.feature.surf.threads = options.index.threads = options.threads;
  return options;
}

Detection describe(const Hypothesis& hypothesis, const SceneContext& scene) {
  const auto& entry = scene.models.views()[static_cast<std::size_t>(hypothesis.view)];
  Detection detection;
  detection.object = scene.models.name_of_view(hypothesis.view);
  detection.view = entry.view->id;
  detection.inliers = static_cast<int>(hypothesis.evidence.inliers.size());
  detection.features_in_area = std::max(hypothesis.features_in_area, detection.inliers);
  detection.confidence = detection.features_in_area > 0
                             ? static_cast<double>(detection.inliers) / detection.features_in_area
                             : 0;
  detection.log10_false_alarms = hypothesis.log10_false_alarms;
  detection.presence = hypothesis.presence;
  detection.measured = hypothesis.measured;
  detection.probability = hypothesis.presence.probability();
  detection.scene_from_view = hypothesis.scene_from_view;
  detection.outline = transform_polygon(hypothesis.scene_from_view, entry.view->outline);
  const cv::Rect2f box = cv::boundingRect(detection.outline);
  detection.box = box;
  for (const int other : hypothesis.alternatives)
    detection.alternatives.push_back(scene.models.objects()[static_cast<std::size_t>(other)].name);
  for (const Match& match : hypothesis.evidence.inliers) {
    const Keypoint& v = entry.view->features.keypoints[static_cast<std::size_t>(match.feature)];
    const Keypoint& s = scene.grid.features().keypoints[static_cast<std::size_t>(match.scene)];
    detection.matches.push_back({{v.x, v.y}, {s.x, s.y}});
  }
  return detection;
}

/// Nothing beyond its reference can match a scene feature, unless the ratio says otherwise. Where
/// somebody marked false detections, none of what he marked may be missed: the search that looks
/// at more is taken.
NeighborLists find_neighbors(const Index& index, const Features& scene, const MatchOptions& options,
                             const std::vector<int>& groups, bool any_marked) {
  const bool rivals_suffice = options.max_ratio < 1 && !any_marked;
  return rivals_suffice ? index.search_rivals(scene, options.neighbors, groups)
                        : index.search(scene, options.neighbors);
}

/// Of the strongest features only, if the time is short.
NeighborLists find_neighbors_in_time(const Index& index, const Features& scene,
                                     const MatchOptions& options, const std::vector<int>& groups,
                                     bool any_marked, const Deadline& deadline, bool& incomplete) {
  if (!deadline.limited()) return find_neighbors(index, scene, options, groups, any_marked);
  constexpr std::size_t kAtOnce = 64;
  NeighborLists result(scene.size(), static_cast<std::size_t>(options.neighbors));
  for (std::size_t first = 0; first < scene.size(); first += kAtOnce) {
    if (deadline.passed(kMatchingEnds)) {
      incomplete = true;
      break;
    }
    const std::size_t end = std::min(scene.size(), first + kAtOnce);
    const Features some{{scene.keypoints.begin() + static_cast<std::ptrdiff_t>(first),
                         scene.keypoints.begin() + static_cast<std::ptrdiff_t>(end)},
                        scene.descriptors.rowRange(static_cast<int>(first), static_cast<int>(end))};
    const NeighborLists found = find_neighbors(index, some, options, groups, any_marked);
    for (std::size_t i = 0; i < found.size(); ++i)
      std::ranges::copy(found[i], result.fill(first + i, found[i].size()));
  }
  return result;
}

void record_matches(const NeighborLists& neighbors, const std::vector<Match>& matches,
                    const std::vector<PoseCluster>& clusters, Trace& trace) {
  for (std::size_t s = 0; s < neighbors.size(); ++s) {
    auto& views = trace.similar_views.emplace_back();
    for (const Neighbor& neighbor : neighbors[s]) views.push_back(neighbor.view);
  }
  trace.matches = matches;
  trace.clusters = clusters;
}

void record_hypotheses(const std::vector<Hypothesis>& hypotheses, const SceneContext& scene,
                       Trace& trace) {
  for (const Hypothesis& hypothesis : hypotheses) {
    TracedHypothesis traced{describe(hypothesis, scene), hypothesis.stage, hypothesis.rejected};
    trace.hypotheses.push_back(std::move(traced));
  }
}

}  // namespace

void RecognizeOptions::describe(OptionList& list) {
  list.add("rule", rule, {"a-contrario", "paper"},
           "How a hypothesis is accepted: by its number of false alarms, or by the paper's rule.");
  list.add("max_hypotheses", max_hypotheses, {1, 1000000}, "",
           "Clusters of votes looked at per picture, strongest first.");
  list.add("deadline_ms", deadline_ms, {0, 1e6}, "ms",
           "Time for a picture, 0 for as much as it takes: then the strongest features and "
           "hypotheses go first, and the result says when it is incomplete.");
  list.add("max_overlap", max_overlap, {0, 1}, "",
           "Overlap (intersection over union) beyond which two detections of one object are one.");
  list.add("threads", threads, {0, 64}, "",
           "Threads for one picture, in all steps; 0 uses one per core. The answer is the same.");
  list.add("unknown", unknown,
           "Also report textured parts of the picture that no object explains.");
  list.group("feature", feature);
  list.group("index", index);
  list.group("match", match);
  list.group("vote", vote);
  list.group("verify", verify);
  list.group("paper", paper);
}

std::vector<std::string> preset_names() {
  return {"default", "paper"};
}

RecognizeOptions make_preset(const std::string& name) {
  RecognizeOptions options;
  if (name == "default") return options;
  if (name == "paper") {
    options.rule = "paper";
    options.vote.grid = "image";
    options.vote.min_votes = 5;
    options.match.max_ratio = 0.8;
    return options;
  }
  const std::string nearest = nearest_word(name, preset_names());
  throw Error(ErrorCode::invalid_argument,
              "there is no preset '" + name + "'; presets are default and paper" +
                  (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

struct Recognizer::State {
  struct Snapshot {
    std::shared_ptr<const ModelSet> models;
    std::shared_ptr<const Index> index;
    LookAlikes look_alikes;
    std::vector<int> groups;  ///< of views, by look_alikes
  };

  RecognizeOptions options;
  std::shared_ptr<const Extractor> extractor;
  std::atomic<std::shared_ptr<const Snapshot>> snapshot;

  RecognitionResult run(const Snapshot& now, const Features& scene, const cv::Mat& image,
                        const Deadline& deadline, Trace* trace = nullptr) const;
  void prepare(std::shared_ptr<const ModelSet> models, const std::string& prepared);
};

RecognitionResult Recognizer::State::run(const Snapshot& now, const Features& scene,
                                         const cv::Mat& image, const Deadline& deadline,
                                         Trace* trace) const {
  RecognitionResult result;
  const cv::Size size = result.image_size = image.size();
  result.counts.features = static_cast<int>(scene.size());
  Stopwatch watch;

  const ModelSet& models = *now.models;
  const Neighborhood neighborhood(
      find_neighbors_in_time(*now.index, scene, options.match, now.groups,
                             !models.impostors().empty(), deadline, result.incomplete),
      models, now.look_alikes.table);
  const auto matches = match_features(neighborhood, options.match);
  result.counts.matched = count_distinct(matches, [](const Match& m) { return m.scene; });
  result.time_ms.match = watch.lap();

  const auto clusters = cluster_votes(matches, scene, size, models, options.vote);
  result.counts.clustered = count_clustered(clusters, matches);
  result.time_ms.vote = watch.lap();

  const SceneGrid grid(scene, size);
  SceneRivals rivals(models, scene, options.verify.evidence.rivals);
  const ScenePyramid pyramid(image);
  const SceneContext context{models, neighborhood, grid, matches, rivals, pyramid};
  if (trace)
    record_matches(now.index->search(scene, options.match.neighbors), matches, clusters, *trace);
  std::vector<Hypothesis> hypotheses;
  if (options.rule == "paper") {
    hypotheses = apply_paper_rule(clusters, context, options.paper);
  } else {
    hypotheses = verify_all(clusters, context, options, deadline, result.incomplete);
    measure_consensus(hypotheses, models);
    for (Hypothesis& hypothesis : hypotheses) rate(hypothesis, options.verify);
    if (trace) record_hypotheses(hypotheses, context, *trace);
    hypotheses = compete(std::move(hypotheses), context, options);
  }
  std::erase_if(hypotheses, [](const Hypothesis& h) { return !h.rejected.empty(); });
  for (const auto& hypothesis : hypotheses) {
    result.detections.push_back(describe(hypothesis, context));
    result.counts.verified += result.detections.back().inliers;
  }
  if (options.rule == "paper")
    std::ranges::stable_sort(result.detections, std::ranges::greater(), &Detection::confidence);
  if (options.unknown) result.unknown = find_unknown(scene, size, result.detections);
  result.time_ms.verify = watch.lap();
  return result;
}

Recognizer::Recognizer(std::shared_ptr<const ModelSet> models, const RecognizeOptions& options,
                       const std::string& prepared)
    : state_(std::make_unique<State>()) {
  state_->options = completed(options);
  state_->extractor = make_extractor(state_->options.feature);
  state_->prepare(std::move(models), prepared);
}

Recognizer::~Recognizer() = default;

RecognitionResult Recognizer::recognize(const cv::Mat& image) const {
  const Deadline deadline(state_->options.deadline_ms);
  Stopwatch watch;
  const Features scene = state_->extractor->extract(image);
  const double detect_ms = watch.lap();
  const auto now = state_->snapshot.load();
  RecognitionResult result = state_->run(*now, scene, image, deadline);
  result.time_ms.detect = detect_ms;
  result.time_ms.total = detect_ms + watch.lap();
  return result;
}

RecognitionResult Recognizer::recognize(const Features& scene, const cv::Mat& image) const {
  Stopwatch watch;
  const auto now = state_->snapshot.load();
  RecognitionResult result = state_->run(*now, scene, image, Deadline(state_->options.deadline_ms));
  result.time_ms.total = watch.lap();
  return result;
}

Trace Recognizer::trace(const cv::Mat& image) const {
  Trace trace;
  const auto now = state_->snapshot.load();
  trace.models = now->models;
  trace.scene = state_->extractor->extract(image);
  trace.detections = state_->run(*now, trace.scene, image, Deadline(0), &trace).detections;
  return trace;
}

void Recognizer::State::prepare(std::shared_ptr<const ModelSet> models,
                                const std::string& prepared_bytes) {
  if (!models->views().empty() && models->signature() != options.feature.signature())
    throw Error(ErrorCode::feature_mismatch,
                "the objects hold features '" + models->signature() + "' but recognition uses '" +
                    options.feature.signature() + "'; choose the same kind or rebuild them");
  const auto before = snapshot.load();
  const Prepared prepared = read_prepared(prepared_bytes, *models);
  auto index = before ? make_index(models, options.index, before->index.get())
                      : load_index(models, prepared.index, options.index);
  LookAlikes look_alikes;
  if (options.rule != "paper")  // which knows none
    look_alikes = find_look_alikes(models, *index,
                                   before                        ? &before->look_alikes
                                   : prepared.look_alikes.models ? &prepared.look_alikes
                                                                 : nullptr);
  auto groups = group_views(*models, look_alikes.table);
  snapshot.store(std::make_shared<const Snapshot>(
      Snapshot{std::move(models), std::move(index), std::move(look_alikes), std::move(groups)}));
}

void Recognizer::set_models(std::shared_ptr<const ModelSet> models) {
  state_->prepare(std::move(models), {});
}

std::string Recognizer::save_prepared() const {
  const auto now = state_->snapshot.load();
  return posevote::save_prepared(*now->index, now->look_alikes);
}

IndexStatistics Recognizer::index_statistics() const {
  return state_->snapshot.load()->index->statistics();
}

std::shared_ptr<const ModelSet> Recognizer::models() const {
  return state_->snapshot.load()->models;
}

const RecognizeOptions& Recognizer::options() const noexcept {
  return state_->options;
}

}  // namespace posevote
