// An evaluation as tables, JSON and one line for each detection.
#pragma once

#include <string>
#include <vector>

#include "posevote/evaluate/evaluator.hpp"
#include "posevote/evaluate/summary.hpp"
#include "posevote/evaluate/table.hpp"

namespace posevote {

/// One row for each group and one for the whole set.
[[nodiscard]] Table group_table(const Evaluation& evaluation);

/// Median and 95th percentile of the time of each step, per group.
[[nodiscard]] Table time_table(const Evaluation& evaluation);

/// One row for each data set and, for several, one for all; with the recall that a threshold chosen
/// afterwards reaches without any false positive on the set and the negatives together.
[[nodiscard]] Table set_table(const std::vector<Evaluation>& evaluations);

/// Median time of each step, a row for each data set.
[[nodiscard]] Table set_time_table(const std::vector<Evaluation>& evaluations);

/// Recall without any false positive for each ranking.
[[nodiscard]] Table ranking_table(const Evaluation& evaluation);

/// What was asked (rows) against what was answered (columns): only names that were confused, missed
/// or claimed where nothing is. "(none)": nothing there, or nothing answered.
[[nodiscard]] Table confusion_table(const Evaluation& evaluation);

/// The same in words, a line for each kind of mistake that was made: missed objects, wrong names,
/// the right name in the wrong place, an instance reported twice, answers where nothing listed is.
[[nodiscard]] std::vector<std::string> mistakes_of(const Evaluation& evaluation);

/// Views that could not be taught.
[[nodiscard]] Table refused_table(const Evaluation& evaluation);

/// The whole evaluation as one JSON object on one line: counts, groups, times, rankings.
[[nodiscard]] std::string to_json(const Evaluation& evaluation);

/// JSON lines: every detection (of the negatives too) with verdict and evidence, and every missed
/// object with "verdict": "missed".
[[nodiscard]] std::string to_json_lines(const Evaluation& evaluation);

}  // namespace posevote
