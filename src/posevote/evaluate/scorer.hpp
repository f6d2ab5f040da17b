// What is right and what is wrong: the scoring rule, a pure function.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/evaluate/dataset.hpp"

namespace posevote {

/// What the scorer needs to know of a detection.
struct Claim {
  std::string object;
  cv::Rect2d box;  ///< px, may reach beyond the picture
  double confidence = 0;
};

enum class Verdict {
  right,           ///< names a listed object that was not found yet, and the boxes agree
  false_positive,  ///< anything else
  twin,     ///< the box fits a listed object that was not reported yet, the name is its twin's
  ignored,  ///< an object that is there, but neither asked for nor wrong
};

[[nodiscard]] const char* to_string(Verdict verdict) noexcept;

struct Judgement {
  Verdict verdict = Verdict::false_positive;
  int truth =
      -1;  ///< the listed object it was judged by; for false positives the nearest, -1: none
  double iou = 0;  ///< intersection over union with that object's box, both cut to the picture
};

struct Score {
  std::vector<Judgement> judgements;  ///< one for each claim, in the order given
  std::vector<int> missed;            ///< listed objects that were asked for and not found
  int asked = 0, right = 0, false_positives = 0, twins = 0, ignored = 0;
};

/// Intersection over union of two boxes after both are cut to a picture of that size (x in [0,
/// width], y in [0, height]); 0 when nothing is left of either.
[[nodiscard]] double clipped_iou(const cv::Rect2d& a, const cv::Rect2d& b, cv::Size picture);

/// Judges `claims` in order of falling confidence (equal: in the order given). Two boxes fit when
/// their `clipped_iou` is at least `min_iou`. A claim is, by the first rule that holds,
///  1. right: it fits an asked object of its name that no claim before it found. Of several the
///  best
///     overlap is taken, and is found from then on;
///  2. ignored: it fits an object of its name that is optional or hidden (as often as it is
///  reported:
///     such an object is never wrong);
///  3. a twin: it fits an object whose twin it names, and nothing has reported that object before,
///     neither right nor as a twin. The object is not found by this: its own name may still be;
///  4. ignored, when by rule 3 the object is optional or hidden;
///  5. a false positive: also a second report of the same instance, an object that lies wholly
///     outside the picture, and a wrong name that is not a declared twin's. `alternatives` do not
///     count: the name that is claimed is judged.
[[nodiscard]] Score score_claims(const std::vector<Claim>& claims, const DatasetTest& test,
                                 const Dataset& dataset, cv::Size picture, double min_iou = 0.5);

}  // namespace posevote
