// How much may a picture suffer? Sweeps of one disturbance over a dataset's own pictures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "posevote/evaluate/method.hpp"
#include "posevote/evaluate/report.hpp"

namespace posevote {

/// A disturbed picture and how it lies over the original: disturbed px from original px.
struct DisturbedPicture {
  cv::Mat picture;
  cv::Matx23d from_original{1, 0, 0, 0, 1, 0};
};

/// "noise", "blur", "jpeg", "light", "rotation", "scale", "occlusion".
[[nodiscard]] const std::vector<std::string>& sweep_names();

/// The levels of a sweep, mildest first, with the unit to print. Throws Error{invalid_argument}.
struct SweepLevels {
  std::string unit;
  std::vector<double> levels;
};
[[nodiscard]] const SweepLevels& sweep_levels(const std::string& name);

/// One picture at one level. 8- or 16-bit pictures of 1, 3 or 4 channels; the result has 8 bits.
///   noise      Gaussian, standard deviation in grey levels of 255
///   blur       Gaussian, sigma in px
///   jpeg       quality 1..100
///   light      brightness falls from left to right, to 1 - level
///   rotation   degrees clockwise; the canvas grows so that nothing is cut
///   scale      factor
///   occlusion  per cent of each object's box in `test` is covered by a smooth random pattern,
///              from a random side
/// The same seed gives the same picture.
[[nodiscard]] DisturbedPicture disturb(const cv::Mat& picture, const std::string& sweep,
                                       double level, const DatasetTest& test, std::uint64_t seed);

/// Recognises every test at every level. Outlines are taken back into the original picture before
/// they are scored, so that the ground truth stays exact. Tests without an asked object are left
/// out. One row for each level, one chart.
[[nodiscard]] ReportSection run_sweep(const std::string& sweep, const Dataset& dataset,
                                      const TaughtMethod& taught, const Method& method,
                                      std::uint64_t seed = 1);

}  // namespace posevote
