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

  /// Of the peaks that `search` found in `integral`. Sorted by `comes_before`, the same for any
  /// number of threads.
  const std::vector<Keypoint>& select(const BlobSearch& search, const Integral& integral,
                                      const SurfOptions& surf, const Options& options, Team& team,
                                      int threads);

 private:
  void count_peaks(const BlobSearch& search);
  bool next_batch(const BlobSearch& search);
  [[nodiscard]] Keypoint examine_one(const Peak& peak, const Integral& integral,
                                     const SurfOptions& surf) const;
  void finish();
  void spread();

  Options options_;
  std::vector<int> counts_;  // peaks of each class of strength; see class_of
  int next_class_ = 0;       // those from here on have been examined
  std::vector<Peak> batch_;
  std::vector<Keypoint> examined_;  // one per peak of the batch; scale 0: refused
  std::vector<Keypoint> kept_, keypoints_;
  std::vector<std::uint64_t> order_;
  std::vector<int> taken_;
};

}  // namespace posevote::surf
