// What the paper's tables are made of; each in a file of its own.
#pragma once

#include "posevote/evaluate/paper.hpp"

namespace posevote {

[[nodiscard]] ReportSection paper_table1(const Dataset& dataset, const Method& method);
[[nodiscard]] ReportSection paper_fig5(const Dataset& dataset, const Method& method);
[[nodiscard]] ReportSection paper_accumulator(const Dataset& dataset, const Method& method);
[[nodiscard]] ReportSection paper_table2(const Dataset& dataset, const Method& method);
[[nodiscard]] ReportSection paper_fig8(const Dataset& dataset, const Method& method);
[[nodiscard]] ReportSection paper_table3(const Dataset& dataset, const Method& method);

/// The dataset with the tests whose group matches; may be none.
[[nodiscard]] Dataset with_groups(Dataset dataset, const std::string& pattern);

/// The dataset with those objects only.
[[nodiscard]] Dataset with_objects(Dataset dataset, const std::vector<std::string>& names);

/// The detection that was judged right for listed object `truth`, or null.
[[nodiscard]] const Detection* right_detection(const TestOutcome& outcome, int truth);

/// Throws Error{invalid_argument}: the dataset cannot give this result because `what` is missing.
[[noreturn]] void refuse(const Dataset& dataset, const std::string& result,
                         const std::string& what);

}  // namespace posevote
