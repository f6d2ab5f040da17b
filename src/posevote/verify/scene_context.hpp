// Everything that verification reads of one scene.
#pragma once

#include <vector>

#include "posevote/index/codes.hpp"
#include "posevote/match/matcher.hpp"
#include "posevote/model/model_set.hpp"
#include "posevote/verify/agreement.hpp"
#include "posevote/verify/scene_grid.hpp"

namespace posevote {

/// How near the scene's features come to a taught feature: the distance of the `rank`-th nearest.
/// Up to `rank` - 1 of them may be copies of the object; the others show that such a descriptor is
/// nothing special here. The strongest 1000 features stand for the scene. Computed on demand and
/// kept; one per scene and thread.
class SceneRivals {
 public:
  SceneRivals(const ModelSet& models, const Features& scene, int rank);

  /// Distance of the rank-th nearest scene feature, and rank / number of scene features. With fewer
  /// features than `rank` the farthest.
  [[nodiscard]] Reference reference(int view, int feature);

  /// Descriptor of a taught feature as 32-bit floats; valid until the next call of a member.
  [[nodiscard]] const float* taught_row(int view, int feature);

 private:
  [[nodiscard]] float nth_distance(const float* taught);

  const ModelSet& models_;
  std::vector<const float*> rows_;  ///< descriptors of the scene
  std::size_t rank_;
  Coder coder_;
  std::vector<std::uint8_t> codes_;            ///< of the rows; none until they are needed
  std::vector<std::vector<float>> distances_;  ///< by view and feature; negative: not computed yet
  // Buffers.
  std::vector<float> row_, nearest_;
  std::vector<std::int8_t> query_;
  std::vector<std::int16_t> products_;
  std::vector<std::uint32_t> positions_;
  std::vector<const float*> chosen_;
};

/// References only: what they name must outlive it.
struct SceneContext {
  const ModelSet& models;
  const Neighborhood& neighborhood;
  const SceneGrid& grid;
  const std::vector<Match>& matches;
  SceneRivals& rivals;
  const ScenePyramid& pyramid;
};

/// Euclidean distance of row `i` of `descriptors`, CV_32F, and another one of their length.
[[nodiscard]] float descriptor_distance(const cv::Mat& descriptors, int i, const float* other);

}  // namespace posevote
