// Key points and descriptors: what every other part of the library reads.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"

namespace posevote {

/// A scale- and rotation-covariant point. Pixel (0,0) is the centre of the top-left pixel, x right,
/// y down, in the picture as it was given (never in a scaled copy).
struct Keypoint {
  float x = 0, y = 0;  ///< px
  float scale = 0;     ///< sigma of the detecting filter, px, > 0
  float angle = 0;     ///< radians in [-pi, pi), from +x towards +y (clockwise as seen)
  float response = 0;  ///< strength; larger is better; comparable within one picture
  std::int8_t laplacian =
      0;  ///< +1 dark blob, -1 bright blob, 0 not known; opposite signs never match
};

/// Key points and one descriptor each, in one order.
struct Features {
  std::vector<Keypoint> keypoints;
  cv::Mat
      descriptors;  ///< keypoints.size() x D, CV_32F, continuous, rows of length 1; empty if none

  [[nodiscard]] std::size_t size() const noexcept { return keypoints.size(); }
  [[nodiscard]] bool empty() const noexcept { return keypoints.empty(); }
};

/// Speeded-Up Robust Features (Bay et al., CVIU 110(3), 2008).
struct SurfOptions {
  double hessian_threshold = 100;  ///< on OpenCV's scale for 8-bit pictures
  int octaves = 4;
  int layers = 2;            ///< per octave, in which key points are looked for; 2 as in the paper
  bool upright = false;      ///< all angles 0
  bool smooth = true;        ///< first filter the picture with a Gaussian of 1 px
  bool double_size = false;  ///< start one octave lower, on the picture enlarged by two
  bool spread = false;       ///< with max_features: the strongest of every part of the picture
  int threads = 1;           ///< 0: one per core; the answer is the same for any number
  void describe(OptionList& list);
};

/// OpenCV's SIFT (Lowe 2004).
struct SiftOptions {
  int layers = 3;
  double contrast_threshold = 0.03;
  double edge_threshold = 10;
  double sigma = 1.6;
  void describe(OptionList& list);
};

/// "surf", or "sift" in a build without our SURF.
[[nodiscard]] std::string default_feature_kind();

struct FeatureOptions {
  std::string kind = default_feature_kind();  ///< "surf" or "sift"
  int max_features = 6000;                    ///< keep the strongest N; 0: all
  bool more_in_large = true;  ///< SURF: beyond 2 megapixels the limit grows with the picture
  int double_below_px =
      600000;  ///< SURF: smaller pictures are searched from one octave lower; 0: none
  SurfOptions surf;
  SiftOptions sift;
  void describe(OptionList& list);

  /// Everything that descriptors must have in common to be compared, e.g. "surf64 1". Two feature
  /// sets of different signature never match; limits and thresholds are not part of it.
  [[nodiscard]] std::string signature() const;
};

/// Finds features in pictures. Const and safe to call from many threads; deterministic.
class Extractor {
 public:
  virtual ~Extractor() = default;

  /// `image`: any size from 1x1, 8- or 16-bit, 1, 3 (BGR) or 4 (BGRA) channels. `mask`: empty, or
  /// CV_8U of the same size, key points where it is 0 are left out. Empty images give no features.
  /// Strongest features first. Throws Error{invalid_argument} for other types or sizes.
  [[nodiscard]] virtual Features extract(const cv::Mat& image,
                                         const cv::Mat& mask = cv::Mat()) const = 0;
};

/// Throws Error{invalid_argument} for values out of range and Error{unsupported} for "surf" in a
/// build without it.
[[nodiscard]] std::shared_ptr<const Extractor> make_extractor(const FeatureOptions& options = {});

/// 8-bit grey of any picture that `Extractor::extract` takes; shares the data where nothing
/// changes. 16-bit pictures are scaled by 1/256; alpha is ignored.
[[nodiscard]] cv::Mat to_grey(const cv::Mat& image);

}  // namespace posevote
