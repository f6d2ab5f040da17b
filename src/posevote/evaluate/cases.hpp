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

/// The cases of one kind, worst first.
struct CaseList {
  std::string title;
  std::vector<Case> cases;
};

/// False positives (of the set, of the negatives), missed objects, twins: what there is of these.
/// Points into `evaluation`.
[[nodiscard]] std::vector<CaseList> worst_cases(const Evaluation& evaluation);

/// What to ask `explain` for: the picture's path, and the object claimed or missed.
[[nodiscard]] std::pair<std::filesystem::path, std::string> question_of(const Case& item);

struct PictureOptions {
  int width = 480;  ///< px; wider pictures are reduced
  int jpeg_quality = 82;
};

/// An HTML <figure>: the test picture with the claim's outline and the box of the listed object
/// drawn over it, a caption, and, with an `explanation`, a fold that says why and draws matches,
/// votes and strongest pose over the picture while it is open. "" when the picture cannot be read.
[[nodiscard]] std::string case_figure(const Case& item, const Explanation* explanation,
                                      const PictureOptions& options);

/// The same for a taught view: the silhouette that was found over the true one.
[[nodiscard]] std::string silhouette_figure(const Dataset& dataset, const SilhouetteCase& item,
                                            const PictureOptions& options);

/// A JPEG as a data URL. Throws Error{unsupported} when it cannot be encoded.
[[nodiscard]] std::string jpeg_data_url(const cv::Mat& picture, int quality);

}  // namespace posevote
