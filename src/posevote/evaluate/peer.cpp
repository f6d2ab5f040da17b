#include "posevote/evaluate/peer.hpp"

#include <algorithm>
#include <chrono>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/summary.hpp"

namespace posevote {
namespace {

constexpr float max_ratio = 0.75F;
constexpr double ransac_error_px = 5;
constexpr int min_inliers = 10;

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

struct PeerFeatures {
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

struct PeerKind {
  const char* name;
  int norm;
  cv::Ptr<cv::Feature2D> (*make)();
};

const PeerKind kinds[] = {
    {"opencv-sift", cv::NORM_L2, [] { return cv::Ptr<cv::Feature2D>(cv::SIFT::create()); }},
    {"opencv-orb", cv::NORM_HAMMING, [] { return cv::Ptr<cv::Feature2D>(cv::ORB::create(2000)); }}};

const PeerKind& find_kind(const std::string& name) {
  for (const PeerKind& kind : kinds)
    if (name == kind.name) return kind;
  std::string known;
  for (const PeerKind& kind : kinds) known += std::string(known.empty() ? "" : ", ") + kind.name;
  throw Error(ErrorCode::invalid_argument, "there is no peer '" + name + "', but " + known);
}

// A detector holds scratch memory, so every call has its own.
PeerFeatures extract(const PeerKind& kind, const cv::Mat& picture, const cv::Mat& mask) {
  PeerFeatures features;
  kind.make()->detectAndCompute(to_grey(picture), mask, features.keypoints, features.descriptors);
  return features;
}

std::vector<cv::DMatch> match(const PeerKind& kind, const PeerFeatures& view,
                              const PeerFeatures& scene) {
  std::vector<std::vector<cv::DMatch>> pairs;
  cv::BFMatcher(kind.norm).knnMatch(view.descriptors, scene.descriptors, pairs, 2);
  std::vector<cv::DMatch> good;
  for (const auto& pair : pairs)
    if (pair.size() == 2 && pair[0].distance < max_ratio * pair[1].distance)
      good.push_back(pair[0]);
  return good;
}

cv::Rect2d bounding_box(const std::vector<cv::Point2f>& outline) {
  float left = outline[0].x, right = left, top = outline[0].y, bottom = top;
  for (const cv::Point2f& point : outline) {
    left = std::min(left, point.x);
    right = std::max(right, point.x);
    top = std::min(top, point.y);
    bottom = std::max(bottom, point.y);
  }
  return {left, top, right - left, bottom - top};
}

// An empty `object` says: not found.
Detection find_view(const View& view, const PeerFeatures& taught, const PeerFeatures& scene,
                    const std::vector<cv::DMatch>& matches) {
  Detection detection;
  if (static_cast<int>(matches.size()) < min_inliers) return detection;
  std::vector<cv::Point2f> from, to;
  for (const cv::DMatch& pair : matches) {
    from.push_back(taught.keypoints[static_cast<std::size_t>(pair.queryIdx)].pt);
    to.push_back(scene.keypoints[static_cast<std::size_t>(pair.trainIdx)].pt);
  }
  cv::Mat inliers;
  const cv::Mat homography = cv::findHomography(from, to, cv::RANSAC, ransac_error_px, inliers);
  if (homography.empty()) return detection;
  detection.inliers = cv::countNonZero(inliers);
  if (detection.inliers < min_inliers) return detection;
  detection.scene_from_view = cv::Matx33d(homography.ptr<double>());
  detection.view = view.id;
  detection.confidence = static_cast<double>(detection.inliers) / double(matches.size());
  cv::perspectiveTransform(view.outline, detection.outline, homography);
  detection.box = bounding_box(detection.outline);
  return detection;
}

std::vector<std::string> comparison_row(const std::string& name, const Dataset& dataset,
                                        const std::vector<TestOutcome>& outcomes,
                                        const Dataset& negatives,
                                        const std::vector<TestOutcome>& negative_outcomes) {
  const Summary s = summarize(name, dataset, outcomes);
  const Summary none = summarize(name, negatives, negative_outcomes);
  const Interval interval = s.recall_interval();
  return {name,
          std::to_string(s.asked),
          std::to_string(s.right),
          percent(s.recall()),
          fixed(100 * interval.low, 1) + ".." + fixed(100 * interval.high, 1),
          std::to_string(s.false_positives),
          std::to_string(s.twins),
          percent(s.precision()),
          none.images > 0 ? std::to_string(none.false_positives) : "-",
          fixed(s.total.median_ms, 0),
          fixed(s.total.p95_ms, 0)};
}

}  // namespace

struct Peer::State {
  const PeerKind& kind;
  struct Taught {
    std::shared_ptr<const View> view;
    std::string object;
    PeerFeatures features;
  };
  std::vector<Taught> views;  // object by object
};

const std::vector<std::string>& peer_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const PeerKind& kind : kinds) list.emplace_back(kind.name);
    return list;
  }();
  return names;
}

Peer::Peer(const std::string& name, const ModelSet& models, int jobs)
    : state_(new State{find_kind(name), {}}) {
  for (const ModelSet::Entry& entry : models.views())
    state_->views.push_back(
        {entry.view, models.objects()[static_cast<std::size_t>(entry.object)].name, {}});
  parallel_for(state_->views.size(), jobs, [&](std::size_t i) {
    const View& view = *state_->views[i].view;
    state_->views[i].features = extract(state_->kind, view.picture, view.mask);
  });
}

Peer::~Peer() = default;

RecognitionResult Peer::recognize(const cv::Mat& picture) const {
  RecognitionResult result;
  result.image_size = picture.size();
  const auto begin = Clock::now();
  const PeerFeatures scene = extract(state_->kind, picture, {});
  result.counts.features = static_cast<int>(scene.keypoints.size());
  result.time_ms.detect = ms_since(begin);
  for (std::size_t i = 0; i < state_->views.size();) {
    Detection best;
    const std::string& object = state_->views[i].object;
    for (; i < state_->views.size() && state_->views[i].object == object; ++i) {
      const auto& taught = state_->views[i];
      if (taught.features.keypoints.empty() || scene.keypoints.size() < 2) continue;
      const auto before_match = Clock::now();
      const auto matches = match(state_->kind, taught.features, scene);
      result.time_ms.match += ms_since(before_match);
      const auto before_verify = Clock::now();
      const Detection found = find_view(*taught.view, taught.features, scene, matches);
      result.time_ms.verify += ms_since(before_verify);
      if (found.inliers >= min_inliers && found.inliers > best.inliers) best = found;
    }
    if (best.inliers == 0) continue;
    best.object = object;
    result.counts.verified += best.inliers;
    result.detections.push_back(std::move(best));
  }
  std::ranges::stable_sort(result.detections, std::greater{}, &Detection::confidence);
  result.time_ms.total = ms_since(begin);
  return result;
}

ReportSection compare_peers(const std::vector<std::string>& names, const Evaluation& ours,
                            const TaughtDataset& taught, const Method& method) {
  Table table;
  table.title = ours.dataset.name + ": peers";
  table.header = {"method", "asked",     "right",      "recall", "95 %", "false",
                  "twins",  "precision", "neg. false", "ms",     "p95"};
  table.rows.push_back(comparison_row("posevote", ours.dataset, ours.outcomes, ours.negatives,
                                      ours.negative_outcomes));
  for (const std::string& name : names) {
    const Peer peer(name, *taught.models, method.jobs);
    const auto run = [&](const Dataset& dataset) {
      return run_tests(
          dataset, [&](const cv::Mat& picture) { return peer.recognize(picture); }, method.jobs,
          task(method.progress, dataset.name + ": " + name));
    };
    table.rows.push_back(
        comparison_row(name, ours.dataset, run(ours.dataset), ours.negatives, run(ours.negatives)));
  }
  table.note =
      "Peers: for each view two nearest neighbours, ratio 0.75, homography by RANSAC with 5 px, at "
      "least 10 inliers, the view's silhouette projected; the same views, masks and pictures, in "
      "the same run.";
  return {ours.dataset.name + ": against the usual script", "", {table}, {}};
}

}  // namespace posevote
