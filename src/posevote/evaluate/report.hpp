// The report: one HTML page that needs nothing else.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posevote/evaluate/cases.hpp"
#include "posevote/evaluate/chart.hpp"
#include "posevote/evaluate/evaluator.hpp"
#include "posevote/evaluate/table.hpp"

namespace posevote {

/// A part of the report beside the evaluation itself: the paper's tables, sweeps, peers.
struct ReportSection {
  std::string title;
  std::string text;  ///< a sentence or two, may be empty
  std::vector<Table> tables;
  std::vector<Chart> charts;
};

/// Title, text and tables, for terminals.
[[nodiscard]] std::string to_text(const ReportSection& section);
/// Title and tables as one line of JSON.
[[nodiscard]] std::string to_json(const ReportSection& section);

struct ReportOptions {
  std::size_t max_cases = 24;       ///< pictures of each kind: false, missed, twins
  std::size_t max_silhouettes = 4;  ///< pictures of the silhouettes that fit worst
  PictureOptions picture;
};

/// Precision over recall for each ranking.
[[nodiscard]] Chart precision_recall_chart(const Evaluation& evaluation);
/// False positives per 1000 pictures of the set, and of the negatives, over the dial, and the line
/// of a dial that means what it says. Up to the default dial.
[[nodiscard]] Chart false_alarm_chart(const Evaluation& evaluation);

/// The whole page as text: style, plots (SVG) and pictures (JPEG in base64) inline. Worst cases
/// first, with what `explain` says of them (see `TaughtMethod::explain_worst`): false positives by
/// falling significance, then missed objects by falling visibility.
/// Deterministic. Pictures of the data sets are read again; one that cannot be read is left out.
[[nodiscard]] std::string make_report(const std::vector<Evaluation>& evaluations,
                                      const std::vector<ReportSection>& sections = {},
                                      const ReportOptions& options = {});

/// Writes `html` as index.html into `folder`, which is made; returns the file's path.
/// Throws Error{io}.
std::filesystem::path write_report(const std::string& html, const std::filesystem::path& folder);

/// Tables and numbers of `make_report` as Markdown, without pictures and plots.
[[nodiscard]] std::string make_markdown(const std::vector<Evaluation>& evaluations,
                                        const std::vector<ReportSection>& sections = {});

}  // namespace posevote
