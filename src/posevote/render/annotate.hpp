// Pictures with what was recognised drawn on them.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "posevote/recognize/recognizer.hpp"

namespace posevote {

struct AnnotateOptions {
  bool points = true;  ///< the matched key points
  bool fill = true;    ///< a tint inside the outline
  /// A TrueType font for the labels; when it cannot be read, OpenCV's plain letters are used.
  std::string font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
};

/// A BGR 8-bit copy of `image` (1, 3 or 4 channels of 8 or 16 bits) with outline, name, sureness
/// and matched key points of every detection, and a plain frame about unknown parts. An object has
/// the same colour in every picture. Sizes of lines and letters follow the picture's size.
/// Detections outside the picture do no harm.
[[nodiscard]] cv::Mat annotate(const cv::Mat& image, const RecognitionResult& result,
                               const AnnotateOptions& options = {});

/// The object's name; where it cannot be told from others, "tea or coffee".
[[nodiscard]] std::string names_of(const Detection& detection);

/// The calibrated probability as people read it, "97 %"; where none was computed, Eq. 11's share.
/// Nothing is quite certain: at most "> 99 %".
[[nodiscard]] std::string sureness(const Detection& detection);

/// The colour (BGR) that stands for an object of that name.
[[nodiscard]] cv::Scalar object_color(const std::string& name);

}  // namespace posevote
