#include "posevote/feature/surf/surf.hpp"

#include <algorithm>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "posevote/core/stopwatch.hpp"
#include "posevote/feature/picture.hpp"
#include "posevote/feature/surf/descriptor.hpp"
#include "posevote/feature/surf/orientation.hpp"

namespace posevote::surf {
namespace {

int team_size(const SurfOptions& options) {
  if (options.threads > 0) return options.threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, Team::kMost);
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
  cv::resize(grey_, doubled_, {}, 2, 2, cv::INTER_LINEAR);
  grey_ = doubled_;
}

const std::vector<Keypoint>& Workspace::find(const cv::Mat& mask, const FeatureOptions& options) {
  Stopwatch watch;
  const int threads = team_size(options.surf);
  Selector::Options selection{options.max_features, options.surf.spread, mask, grey_.size()};
  if (!mask.empty() && mask.size() != grey_.size()) {
    cv::resize(mask, mask_, grey_.size(), 0, 0, cv::INTER_NEAREST);
    selection.mask = mask_;
  }
  integral_.compute(grey_, options.surf.smooth, options.surf.octaves, team_, threads);
  times_.integral = watch.lap();
  search_.search(integral_, options.surf, team_, threads);
  times_.hessian = watch.lap();
  const auto& found = selector_.select(search_, integral_, options.surf, selection, team_, threads);
  times_.suppression = watch.lap();
  return found;
}

// By squares of 32 x 32 px, row by row: the sums of one key point are in the cache for the next.
void Workspace::sort_by_place(const std::vector<Keypoint>& keypoints) {
  constexpr int kTile = 32;
  const int columns = grey_.cols / kTile + 1, rows = grey_.rows / kTile + 1;
  const auto tile_of = [&](const Keypoint& keypoint) {
    const auto along = [](float at, int count) {
      return std::clamp(static_cast<int>(at) / kTile, 0, count - 1);
    };
    return along(keypoint.y, rows) * columns + along(keypoint.x, columns);
  };
  tile_ends_.assign(static_cast<std::size_t>(columns) * rows + 1, 0);
  for (const Keypoint& keypoint : keypoints) ++tile_ends_[tile_of(keypoint) + 1];
  std::partial_sum(tile_ends_.begin(), tile_ends_.end(), tile_ends_.begin());
  order_.resize(keypoints.size());
  for (std::size_t i = 0; i < keypoints.size(); ++i)
    order_[tile_ends_[tile_of(keypoints[i])]++] = static_cast<int>(i);
}

cv::Mat Workspace::describe_all(std::vector<Keypoint>& keypoints, const FeatureOptions& options,
                                bool with_descriptors) {
  if (keypoints.empty()) return {};
  const int count = static_cast<int>(keypoints.size());
  cv::Mat descriptors;
  if (with_descriptors) descriptors.create(count, kDescriptorSize, CV_32F);
  Stopwatch watch;
  sort_by_place(keypoints);
  const int threads = team_size(options.surf);
  if (!options.surf.upright) {
    angles_.resize(keypoints.size());  // by place: threads do not write to the same cache lines
    team_.share_ranges(threads, count, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) angles_[k] = orientation(integral_, keypoints[order_[k]]);
    });
    for (int k = 0; k < count; ++k) keypoints[order_[k]].angle = angles_[k];
  }
  times_.orientation = watch.lap();
  if (!with_descriptors) return descriptors;
  team_.share_ranges(threads, count, [&](int begin, int end) {
    for (int k = begin; k < end; ++k)
      surf::describe(integral_, keypoints[order_[k]], descriptors.ptr<float>(order_[k]));
  });
  times_.descriptor = watch.lap();
  return descriptors;
}

Features Workspace::extract(const cv::Mat& image, const cv::Mat& mask,
                            const FeatureOptions& options, bool with_descriptors) {
  times_ = {};
  check_mask(image, mask);
  team_.wake(team_size(options.surf));
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
  integral_.compute(grey_, options.surf.smooth, 1, team_, team_size(options.surf));
  if (options.surf.double_size) scale_keypoints(keypoints, 2);
  cv::Mat descriptors = describe_all(keypoints, options, true);
  if (options.surf.double_size) scale_keypoints(keypoints, 0.5F);
  return descriptors;
}

}  // namespace posevote::surf
