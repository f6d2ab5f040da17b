// Between Python and the library: pictures, arrays, options, JSON.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/core/error.hpp"
#include "posevote/core/options.hpp"
#include "posevote/json/recognition_json.hpp"

namespace posevote::python {

namespace py = pybind11;

/// A keyword that no option has; becomes posevote.OptionError.
struct UnknownOption : Error {
  explicit UnknownOption(const std::string& message)
      : Error(ErrorCode::invalid_argument, message) {}
};

/// A picture that reads a numpy array in place, and what keeps the array alive.
struct Picture {
  py::array array;
  cv::Mat image;
  bool in_place = true;  ///< false: the array's layout made a copy necessary
};

/// uint8 or uint16, H x W or H x W x 1, 3 (BGR) or 4 (BGRA). Rows may lie apart; arrays whose
/// pixels do not stand one after the other are copied. Throws Error{invalid_argument} for anything
/// else; `what` names the argument.
[[nodiscard]] Picture picture_of(const py::object& object, const char* what = "image");

/// The same of a mask, for which bool is allowed too (True: 255); None: an empty one.
[[nodiscard]] Picture mask_of(const py::object& object);

/// A read-only array of the matrix, which it shares and keeps; None of an empty one.
[[nodiscard]] py::object to_array(const cv::Mat& matrix);

/// A read-only N x 2 array, as a copy.
[[nodiscard]] py::array points_array(const std::vector<cv::Point2f>& points);

/// What `json.loads` makes of it.
[[nodiscard]] py::object to_python(const std::string& json);

/// None for NaN and infinities.
[[nodiscard]] py::object number_or_none(double value);

/// "match.max_ratio" as a keyword: "match_max_ratio".
[[nodiscard]] std::string keyword_of(const std::string& option);

/// Sets the options that `keywords` name; `prefix` may be left out. Throws UnknownOption with the
/// nearest keyword, Error{invalid_argument} for values out of range or of another type.
void apply_keywords(const OptionList& list, const py::dict& keywords,
                    const std::string& prefix = "");

/// A value as `OptionList::set` reads it.
[[nodiscard]] std::string option_text(const OptionField& field, const py::handle& value);

/// Name, default, range, unit and help of each, as Python reads them.
[[nodiscard]] py::list describe_options(const OptionList& list, const std::string& prefix = "");

template <class Options>
[[nodiscard]] py::list describe_defaults(Options options = {}) {
  return describe_options(list_options(options));
}

/// `doc` with the options below it, for help(). The library's description is their only source.
[[nodiscard]] std::string with_options(const std::string& doc, const py::list& options);

/// Runs `work` while other Python threads run, too.
template <class Work>
auto without_gil(Work work) {
  const py::gil_scoped_release release;
  return work();
}

/// Each adds its part to the module.
void bind_images(py::module_& module);
void bind_features(py::module_& module);
void bind_teaching(py::module_& module);
void bind_results(py::module_& module);
void bind_recognition(py::module_& module);
void bind_summaries(py::module_& module);
void bind_store(py::module_& module);
void bind_evaluation(py::module_& module);

}  // namespace posevote::python
