// Where is the object? From a picture of it and one of the background alone (paper, III.A).
//
// Each pixel is weighed: how well does the background, lit or shaded, explain its colour, and how
// well would an object - of any colour, of the colours that its sure part shows, or plain? A plain
// patch as dark as a shadow could be either; there the borders decide: a shadow fades in, an object
// begins where the camera is sharp. Both together are the energy of a graph cut (Boykov & Jolly
// 2001), solved in a small copy, learning shadow and colours anew in each round; then the border
// alone in a larger one.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "posevote/core/options.hpp"
#include "posevote/teach/appearance.hpp"

namespace posevote {

struct SegmentOptions {
  ShadowOptions shadow;
  int coarse_pixels = 80000;    ///< size of the copy that the object is found in, at most
  int working_pixels = 400000;  ///< size of the copy that its border is found in, at most
  int rounds = 2;               ///< times that shadow and colours are learned in the small copy
  /// Weight of a pixel's own evidence: neighbours are not independent witnesses (smoothing, JPEG
  /// and light reach over several pixels).
  double evidence = 0.25;
  double bias = 0.3;  ///< nats per pixel of the small copy for the object when it could be either
  double smoothness = 14;        ///< nats per pixel of a border where no edge is seen
  double max_coverage = 0.9;     ///< share of the picture; an object that covers more is refused
  double min_coverage = 0.0005;  ///< share of the picture; what covers less is nothing
  double part_share = 0.04;      ///< further parts count from this share of the largest
  void describe(OptionList& list);
};

/// Finds what is in `picture` and not in `background`, without its shadow: CV_8U, 0 or 255, size of
/// the picture, holes filled unless the background is seen through them. Both: BGR, BGRA or grey, 8
/// or 16 bits, any size from 1x1. Exposure, white balance and a shift of up to 2 % may differ.
/// Deterministic and safe to call from many threads. Throws Error{invalid_argument} when the sizes
/// differ or a type is not allowed, Error{unusable_view} with advice when nothing, nearly
/// everything, or something that reaches all four sides is found, or when the fine structure of the
/// two backgrounds does not agree: the camera has moved.
[[nodiscard]] cv::Mat segment_by_background(const cv::Mat& picture, const cv::Mat& background,
                                            const SegmentOptions& options = {});

/// BGR 8-bit copy of a grey, BGR or BGRA picture of 8 or 16 bits (16-bit values / 256, alpha
/// dropped). Throws Error{invalid_argument} for other types and for an empty picture.
[[nodiscard]] cv::Mat to_bgr8(const cv::Mat& picture);

/// "640 x 480 px"
[[nodiscard]] std::string size_text(const cv::Mat& picture);

}  // namespace posevote
