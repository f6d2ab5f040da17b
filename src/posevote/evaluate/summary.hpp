// Numbers from an evaluation: per group and whole, and how they change with the dial.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "posevote/evaluate/evaluator.hpp"
#include "posevote/evaluate/statistics.hpp"

namespace posevote {

struct TimeSummary {
  double median_ms = 0, p95_ms = 0;  ///< NaN when no picture was read
};

struct Summary {
  std::string name;
  int images = 0, unreadable = 0;
  int asked = 0, right = 0, false_positives = 0, twins = 0, ignored = 0;
  TimeSummary detect, match, vote, verify, total;

  [[nodiscard]] double recall() const;             ///< right / asked, NaN when nothing was asked
  [[nodiscard]] Interval recall_interval() const;  ///< Wilson, 95 %
  [[nodiscard]] double precision() const;          ///< right / (right + false), NaN without any
  [[nodiscard]] double false_positives_per_image() const;
};

/// Of the outcomes whose test satisfies `wanted` (empty: of all).
[[nodiscard]] Summary summarize(const std::string& name, const Dataset& dataset,
                                const std::vector<TestOutcome>& outcomes,
                                const std::function<bool(const DatasetTest&)>& wanted = {});

/// One summary for each group, in the order of `Dataset::groups`.
[[nodiscard]] std::vector<Summary> summarize_groups(const Dataset& dataset,
                                                    const std::vector<TestOutcome>& outcomes);

/// A number by which detections can be ranked; larger is surer.
struct Ranking {
  std::string name;
  double (*value)(const Detection&);
};

/// probability, significance (-log10 of the expected false alarms), confidence (Eq. 11), inliers.
[[nodiscard]] const std::vector<Ranking>& rankings();
/// Throws Error{invalid_argument} for a name that is none.
[[nodiscard]] const Ranking& ranking(const std::string& name);

/// A detection as a curve sees it. Twins and ignored ones are left out.
struct RankedDetection {
  double value = 0;
  bool right = false;
};

[[nodiscard]] std::vector<RankedDetection> rank_detections(const std::vector<TestOutcome>& outcomes,
                                                           const Ranking& ranking);

/// Of the set and, the false ones only, of the negatives.
[[nodiscard]] std::vector<RankedDetection> rank_with_negatives(const Evaluation& evaluation,
                                                               const Ranking& ranking);

/// What is left when only detections with at least `threshold` count. Verdicts are those of the
/// whole run: a duplicate does not become right when the claim before it is left out.
struct CurvePoint {
  double threshold = 0;
  int right = 0, false_positives = 0;
};

/// One point for each different value, highest threshold first. Equal values go together.
[[nodiscard]] std::vector<CurvePoint> make_curve(std::vector<RankedDetection> detections);

/// The share of `asked` that is right above the highest-ranked false positive: the recall at the
/// threshold, chosen afterwards, that lets no false positive through. NaN when nothing was asked.
[[nodiscard]] double recall_without_false_positives(const std::vector<RankedDetection>& detections,
                                                    int asked);

}  // namespace posevote
