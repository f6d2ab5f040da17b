// The pictures of a report: what was claimed, what was missed.
#pragma once

#include <string>
#include <vector>

#include "posevote/evaluate/evaluator.hpp"

namespace posevote {

/// One thing to look at: a detection, or a missed object.
struct Case {
  const Dataset* dataset = nullptr;
  const TestOutcome* outcome = nullptr;
  int detection = -1;  ///< index into the outcome's detections, or -1
  int truth = -1;      ///< index into the test's objects, or -1
};

/// Detections of that verdict, surest first (significance, then probability, then order).
[[nodiscard]] std::vector<Case> cases_of(const Dataset& dataset,
                                         const std::vector<TestOutcome>& outcomes, Verdict verdict);

/// Missed objects, those that were best to see first (visible share, then area).
[[nodiscard]] std::vector<Case> missed_cases(const Dataset& dataset,
                                             const std::vector<TestOutcome>& outcomes);

/// An HTML <figure>: the test picture with the claim's outline and the box of the listed object
/// drawn over it, and a caption. "" when the picture cannot be read.
[[nodiscard]] std::string case_figure(const Case& item, int picture_width, int jpeg_quality);

/// A JPEG as a data URL. Throws Error{unsupported} when it cannot be encoded.
[[nodiscard]] std::string jpeg_data_url(const cv::Mat& picture, int quality);

}  // namespace posevote
