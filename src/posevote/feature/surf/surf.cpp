#include "posevote/feature/surf/surf.hpp"

#include <algorithm>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "posevote/core/stopwatch.hpp"
#include "posevote/feature/picture.hpp"
#include "posevote/feature/surf/descriptor.hpp"
#include "posevote/feature/surf/orientation.hpp"
#include "posevote/feature/surf/select.hpp"

namespace posevote::surf {
namespace {

int team_size(const SurfOptions& options) {
  if (options.threads > 0) return options.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Pixel centres of the doubled picture lie at (x + 0.5) / 2 - 0.5 of the one given.
void scale_keypoints(std::vector<Keypoint>& keypoints, float factor) {
  for (Keypoint& point : keypoints) {
    point.x = (point.x + 0.5F) * factor - 0.5F;
    point.y = (point.y + 0.5F) * factor - 0.5F;
    point.scale *= factor;
  }
}

}  // namespace

void Workspace::load(const cv::Mat& image, const FeatureOptions& options) {
  grey_ = to_grey(image);
  if (!options.surf.double_size || grey_.empty()) return;
  cv::Mat doubled;
  cv::resize(grey_, doubled, {}, 2, 2, cv::INTER_LINEAR);
  grey_ = doubled;
}

std::vector<Keypoint> Workspace::find(const cv::Mat& mask, const FeatureOptions& options) {
  Stopwatch watch;
  const int team = team_size(options.surf);
  integral_.prepare(grey_, options.surf.smooth, team);
  search_.prepare(integral_, options.surf, team);
  std::vector<const std::vector<Candidate>*> shares(team);
  run_team(team, [&](const Member& member) {
    integral_.compute(member);
    if (member.index() == 0) times_.integral = watch.lap();
    shares[member.index()] = &search_.search(member);
  });
  times_.hessian = watch.lap();
  std::vector<const Candidate*> candidates;
  for (const auto* share : shares)
    for (const Candidate& candidate : *share) candidates.push_back(&candidate);
  cv::Mat scaled_mask = mask;
  if (!mask.empty() && mask.size() != grey_.size())
    cv::resize(mask, scaled_mask, grey_.size(), 0, 0, cv::INTER_NEAREST);
  auto keypoints =
      select(std::move(candidates),
             {options.max_features, options.surf.spread, scaled_mask, grey_.size()}, integral_);
  times_.selection = watch.lap();
  return keypoints;
}

cv::Mat Workspace::describe_all(std::vector<Keypoint>& keypoints, const FeatureOptions& options,
                                bool with_descriptors) {
  if (keypoints.empty()) return {};
  const int count = static_cast<int>(keypoints.size());
  cv::Mat descriptors;
  if (with_descriptors) descriptors.create(count, kDescriptorSize, CV_32F);
  // In scan order the sums of one key point are in the cache for the next.
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int i) {
    return std::pair(static_cast<int>(keypoints[i].y) / 32, keypoints[i].x);
  });
  Stopwatch watch;
  if (with_descriptors) boxes_.prepare(integral_, keypoints);
  run_team(team_size(options.surf), [&](const Member& member) {
    if (!options.surf.upright)
      for (int k = member.begin(count); k < member.end(count); ++k)
        keypoints[order[k]].angle = orientation(integral_, keypoints[order[k]]);
    if (member.index() == 0) times_.orientation = watch.lap();
    if (!with_descriptors) return;
    boxes_.compute(member);
    for (int k = member.begin(count); k < member.end(count); ++k)
      surf::describe(integral_, boxes_, keypoints[order[k]], descriptors.ptr<float>(order[k]));
  });
  times_.descriptor = watch.lap();
  return descriptors;
}

Features Workspace::extract(const cv::Mat& image, const cv::Mat& mask,
                            const FeatureOptions& options, bool with_descriptors) {
  times_ = {};
  check_mask(image, mask);
  load(image, options);
  Features features;
  if (grey_.empty()) return features;
  features.keypoints = find(mask, options);
  features.descriptors = describe_all(features.keypoints, options, with_descriptors);
  if (options.surf.double_size) scale_keypoints(features.keypoints, 0.5F);
  grey_.release();
  return features;
}

cv::Mat Workspace::describe(const cv::Mat& image, std::vector<Keypoint>& keypoints,
                            const FeatureOptions& options) {
  load(image, options);
  if (grey_.empty() || keypoints.empty()) return {};
  const int team = team_size(options.surf);
  integral_.prepare(grey_, options.surf.smooth, team);
  run_team(team, [&](const Member& member) { integral_.compute(member); });
  if (options.surf.double_size) scale_keypoints(keypoints, 2);
  cv::Mat descriptors = describe_all(keypoints, options, true);
  if (options.surf.double_size) scale_keypoints(keypoints, 0.5F);
  return descriptors;
}

}  // namespace posevote::surf
