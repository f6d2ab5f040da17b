// 4-D Hough clustering: every match votes for the pose of its object (paper, III.B.2; Eq. 1-10).
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/match/matcher.hpp"
#include "posevote/model/model_set.hpp"

namespace posevote {

/// Where a match puts its object: a similarity transform, by what it does to the view's centre.
struct PoseVote {
  cv::Point2f
      centre;  ///< centroid of the object in the scene, px; may lie outside the picture (Eq. 3)
  float scale = 1;  ///< scene px per view px (Eq. 9)
  float angle = 0;  ///< rotation view -> scene, radians in [-pi, pi): theta_s - theta_o, signed
};

/// Eq. 1-3 and 9 for one pair of key points.
[[nodiscard]] PoseVote vote_of(const Keypoint& scene, const Keypoint& view,
                               cv::Point2f view_centre);

struct VoteOptions {
  std::string grid =
      "object";  ///< "image": the paper's; "object": positions in units of the object
  int bins_x = 10, bins_y = 10, bins_scale = 10, bins_rotation = 10;  ///< of the grid "image"
  int octaves = 4;                                                    ///< n of Eq. 10
  int min_votes = 4;        ///< a bin with at least so many scene features is looked at
  double cell_size = 0.25;  ///< grid "object": side of a position bin, in object sizes
  void describe(OptionList& list);
};

/// The matches of one view that fell into one bin of the accumulator.
struct PoseCluster {
  int view = 0;              ///< index into ModelSet::views()
  std::vector<int> matches;  ///< indices into the matches, ascending
  int support = 0;           ///< number of different scene features among them
  PoseVote pose;             ///< mean of the votes
};

/// Bins with enough support, strongest first (ties: lower view, then order of the bins). A match
/// casts 16 votes: the two closest bins in each dimension. Rotation wraps; scales out of range go
/// to the end bin; positions outside the picture have bins like any other. Bins that hold exactly
/// the same matches as a stronger or earlier one are reported once.
[[nodiscard]] std::vector<PoseCluster> cluster_votes(const std::vector<Match>& matches,
                                                     const Features& scene, cv::Size scene_size,
                                                     const ModelSet& models,
                                                     const VoteOptions& options);

}  // namespace posevote
