// The paper's evaluation (section IV), on anyone's pictures, beside the paper's own numbers.
//
// Each result needs tests of certain groups or fields; a dataset without them is refused with a
// sentence that names what is missing.
//   table1       one object in the picture; groups named "*weak*" are preferred
//   fig5         groups "yaw", "roll" and "scale", with the field of that name
//   accumulator  any tests
//   table2       groups "*homogeneous", "*weak" and "*strong"
//   fig8         groups "occlusion *", with the field `occlusion`
//   table3       groups that end with the megapixels: "* 4mp", "* 8mp"
#pragma once

#include <string>
#include <vector>

#include "posevote/evaluate/method.hpp"
#include "posevote/evaluate/report.hpp"

namespace posevote {

/// "table1", "fig5", "accumulator", "table2", "fig8", "table3".
[[nodiscard]] const std::vector<std::string>& paper_result_names();

/// Teaches and recognises what the result needs and puts it into tables and charts. Throws
/// Error{invalid_argument} for an unknown name or a dataset that lacks the groups.
[[nodiscard]] ReportSection reproduce(const std::string& name, const Dataset& dataset,
                                      const Method& method);

/// The results that `reproduce` can make of this dataset, without accumulator, which any has.
[[nodiscard]] std::vector<std::string> results_for(const Dataset& dataset);

}  // namespace posevote
