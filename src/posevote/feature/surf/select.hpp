// Which of all peaks become key points.
#pragma once

#include <cstdint>
#include <vector>

#include "posevote/feature/surf/hessian.hpp"

namespace posevote::surf {

/// The strongest peaks that are maxima over scale too, can be refined and lie inside the mask. Of
/// all peaks only about as many are examined as are needed for the number that is asked for, the
/// strongest first. Keeps its buffers between pictures.
class Selector {
 public:
  struct Options {
    int max_features = 0;  ///< 0: all
    bool spread = false;   ///< prefer the strongest of every part of the picture
    cv::Mat mask;          ///< empty or of the picture's size; see Extractor::extract
    cv::Size size;         ///< of the picture, px
  };

  /// `integral` must outlive the use; `peaks` may be filled later, before the first `select`.
  void prepare(const Integral& integral, const SurfOptions& surf, const Options& options);
  [[nodiscard]] std::vector<Peak>& peaks() noexcept { return peaks_; }
  /// Each member of a team calls this once, after all have found the peaks.
  void select(const Member& member);
  /// After that: sorted by `comes_before`, the same for any team and order of the peaks' finding.
  [[nodiscard]] const std::vector<Keypoint>& keypoints() const noexcept { return keypoints_; }

 private:
  void lead(void (Selector::*step)());
  void begin();
  void next_batch();
  void examine_batch(const Member& member);
  void keep_batch();
  void finish();
  void spread();

  const Integral* integral_ = nullptr;
  SurfOptions surf_;
  Options options_;
  std::vector<Peak> peaks_;
  std::vector<std::uint64_t> keys_;   // of all peaks not yet examined; see key_of
  std::vector<std::uint32_t> batch_;  // indices of peaks
  std::vector<Keypoint> examined_;    // one per index in the batch; scale 0: refused
  std::vector<Keypoint> kept_, keypoints_;
  std::vector<std::uint64_t> order_;
  std::vector<int> taken_;
};

}  // namespace posevote::surf
