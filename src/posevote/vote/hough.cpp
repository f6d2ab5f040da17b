#include "posevote/vote/hough.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <set>

namespace posevote {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

float wrap_angle(float angle) {
  angle = std::fmod(angle + kPi, 2 * kPi);
  if (angle < 0) angle += 2 * kPi;
  return angle - kPi;
}

/// One of the bins that a vote falls into, in one number: rotation, scale, y, x. Rotation and scale
/// have at most 1000 bins, and positions are bounded by `is_sane`.
std::uint64_t bin_of(int rotation, int scale, int y, int x) {
  constexpr int kBits = 22, kOffset = 1 << (kBits - 1);
  return (static_cast<std::uint64_t>(rotation) << (2 * kBits + 10)) |
         (static_cast<std::uint64_t>(scale) << (2 * kBits)) |
         (static_cast<std::uint64_t>(y + kOffset) << kBits) |
         static_cast<std::uint64_t>(x + kOffset);
}

struct Entry {
  std::uint64_t bin;
  int match;
};

/// Index of the lower of the two bins whose centres are closest to `position` (in bins).
int lower_bin(float position) {
  return static_cast<int>(std::floor(position - 0.5F));
}

int modulo(int index, int bins) {
  return ((index % bins) + bins) % bins;
}

/// Bins of a vote in one grid.
class Grid {
 public:
  Grid(const VoteOptions& options, cv::Size scene_size, float object_size)
      : options_(options), scene_size_(scene_size), object_size_(object_size) {}

  void add(const PoseVote& vote, int match, std::vector<Entry>& entries) const {
    const int r0 =
        lower_bin((vote.angle + kPi) * static_cast<float>(options_.bins_rotation) / (2 * kPi));
    const int s0 = lower_bin(scale_position(vote.scale));
    for (int s = std::max(0, s0); s <= std::min(options_.bins_scale - 1, s0 + 1); ++s)
      add_positions(vote, match, s, r0, entries);
    if (s0 < -1) add_positions(vote, match, 0, r0, entries);
    if (s0 >= options_.bins_scale) add_positions(vote, match, options_.bins_scale - 1, r0, entries);
  }

 private:
  /// Eq. 10 before it is rounded down.
  [[nodiscard]] float scale_position(float scale) const {
    const auto octaves = static_cast<float>(2 * std::max(1, options_.octaves - 1));
    return (std::log2(scale) / octaves + 0.5F) * static_cast<float>(options_.bins_scale);
  }

  /// Side of a position bin in px.
  [[nodiscard]] cv::Size2f cell(int scale_bin) const {
    if (options_.grid == "image")
      return {static_cast<float>(scene_size_.width) / static_cast<float>(options_.bins_x),
              static_cast<float>(scene_size_.height) / static_cast<float>(options_.bins_y)};
    const float position =
        (static_cast<float>(scale_bin) + 0.5F) / static_cast<float>(options_.bins_scale) - 0.5F;
    const auto octaves = static_cast<float>(2 * std::max(1, options_.octaves - 1));
    const float side = std::max(
        1.F, static_cast<float>(options_.cell_size) * object_size_ * std::exp2(position * octaves));
    return {side, side};
  }

  void add_positions(const PoseVote& vote, int match, int scale_bin, int r0,
                     std::vector<Entry>& entries) const {
    const cv::Size2f side = cell(scale_bin);
    const int x0 = lower_bin(vote.centre.x / side.width);
    const int y0 = lower_bin(vote.centre.y / side.height);
    for (int r = r0; r <= r0 + 1; ++r)
      for (int y = y0; y <= y0 + 1; ++y)
        for (int x = x0; x <= x0 + 1; ++x)
          entries.push_back({bin_of(modulo(r, options_.bins_rotation), scale_bin, y, x), match});
  }

  const VoteOptions& options_;
  cv::Size scene_size_;
  float object_size_;
};

int count_scene_features(const std::vector<int>& cluster, const std::vector<Match>& matches) {
  std::vector<int> scene;
  scene.reserve(cluster.size());
  for (const int m : cluster) scene.push_back(matches[static_cast<std::size_t>(m)].scene);
  std::ranges::sort(scene);
  return static_cast<int>(std::unique(scene.begin(), scene.end()) - scene.begin());
}

PoseVote mean_pose(const std::vector<int>& cluster, const std::vector<PoseVote>& votes) {
  cv::Point2f centre, direction;
  float log_scale = 0;
  for (const int m : cluster) {
    const PoseVote& vote = votes[static_cast<std::size_t>(m)];
    centre += vote.centre;
    direction += {std::cos(vote.angle), std::sin(vote.angle)};
    log_scale += std::log(vote.scale);
  }
  const auto n = static_cast<float>(cluster.size());
  return {centre / n, std::exp(log_scale / n), std::atan2(direction.y, direction.x)};
}

/// A votes' centre beyond this is numerical nonsense (a degenerate scale ratio), not a pose.
bool is_sane(const PoseVote& vote) {
  constexpr float far = 1e6F;
  return std::isfinite(vote.centre.x) && std::isfinite(vote.centre.y) &&
         std::abs(vote.centre.x) < far && std::abs(vote.centre.y) < far && vote.scale > 0;
}

void cluster_view(int view, const std::vector<int>& own, const std::vector<Match>& matches,
                  const std::vector<PoseVote>& votes, const Grid& grid, int min_votes,
                  std::vector<PoseCluster>& clusters) {
  std::vector<Entry> entries;
  entries.reserve(own.size() * 16);
  for (const int m : own)
    if (is_sane(votes[static_cast<std::size_t>(m)]))
      grid.add(votes[static_cast<std::size_t>(m)], m, entries);
  std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
    return std::tie(a.bin, a.match) < std::tie(b.bin, b.match);
  });
  std::set<std::vector<int>> known;
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    std::vector<int> members;
    for (; end < entries.size() && entries[end].bin == entries[begin].bin; ++end)
      if (members.empty() || members.back() != entries[end].match)
        members.push_back(entries[end].match);
    if (static_cast<int>(members.size()) < min_votes) continue;
    const int support = count_scene_features(members, matches);
    if (support < min_votes || !known.insert(members).second) continue;
    clusters.push_back({view, members, support, mean_pose(members, votes)});
  }
}

}  // namespace

void VoteOptions::describe(OptionList& list) {
  list.add("grid", grid, {"image", "object"},
           "Position bins as shares of the picture (the paper's) or of the object's size.");
  list.add("bins_x", bins_x, {1, 1000}, "", "Position bins across the picture, grid 'image'.");
  list.add("bins_y", bins_y, {1, 1000}, "", "Position bins down the picture, grid 'image'.");
  list.add("bins_scale", bins_scale, {1, 1000}, "", "Scale bins.");
  list.add("bins_rotation", bins_rotation, {1, 1000}, "", "Rotation bins of the full circle.");
  list.add("octaves", octaves, {1, 12}, "",
           "Octaves n of Eq. 10: the scale bins span 2(n-1) doublings about 1.");
  list.add("min_votes", min_votes, {1, 1000}, "", "Scene features that make a bin a hypothesis.");
  list.add("cell_size", cell_size, {0.01, 10}, "",
           "Side of a position bin in units of the object's size, grid 'object'.");
}

PoseVote vote_of(const Keypoint& scene, const Keypoint& view, cv::Point2f view_centre) {
  const float scale = scene.scale / view.scale;
  const float angle = wrap_angle(scene.angle - view.angle);
  const float dx = (view_centre.x - view.x) * scale;
  const float dy = (view_centre.y - view.y) * scale;
  const float cosine = std::cos(angle), sine = std::sin(angle);
  return {{scene.x + cosine * dx - sine * dy, scene.y + sine * dx + cosine * dy}, scale, angle};
}

std::vector<PoseCluster> cluster_votes(const std::vector<Match>& matches, const Features& scene,
                                       cv::Size scene_size, const ModelSet& models,
                                       const VoteOptions& options) {
  std::vector<std::vector<int>> of_view(models.views().size());
  std::vector<PoseVote> votes(matches.size());
  for (std::size_t m = 0; m < matches.size(); ++m) {
    const Match& match = matches[m];
    const View& view = *models.views()[static_cast<std::size_t>(match.view)].view;
    votes[m] =
        vote_of(scene.keypoints[static_cast<std::size_t>(match.scene)],
                view.features.keypoints[static_cast<std::size_t>(match.feature)], view.centre);
    of_view[static_cast<std::size_t>(match.view)].push_back(static_cast<int>(m));
  }
  std::vector<PoseCluster> clusters;
  for (std::size_t v = 0; v < of_view.size(); ++v) {
    if (static_cast<int>(of_view[v].size()) < options.min_votes) continue;
    const cv::Rect2f box = cv::boundingRect(models.views()[v].view->outline);
    const Grid grid(options, scene_size, std::sqrt(std::max(1.F, box.area())));
    cluster_view(static_cast<int>(v), of_view[v], matches, votes, grid, options.min_votes,
                 clusters);
  }
  std::ranges::stable_sort(clusters, std::ranges::greater(), &PoseCluster::support);
  return clusters;
}

}  // namespace posevote
