#include "convert.hpp"

#include <algorithm>
#include <climits>
#include <cmath>

namespace posevote::python {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::invalid_argument, message);
}

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    text += (i ? ", " : "") + std::to_string(array.shape(i));
  return text + ")";
}

py::array array_of(const py::object& object, const char* what) {
  if (py::isinstance<py::array>(object)) return py::reinterpret_borrow<py::array>(object);
  if (PyObject_CheckBuffer(object.ptr()) && !PyBytes_Check(object.ptr()) &&
      !PyByteArray_Check(object.ptr()))
    return py::array(py::reinterpret_borrow<py::buffer>(object));
  refuse(std::string(what) + " must be a numpy array (uint8, H x W or H x W x 3 in BGR), not " +
         std::string(py::str(py::type::of(object).attr("__name__"))));
}

int depth_of(const py::array& array, const char* what) {
  if (py::isinstance<py::array_t<std::uint8_t>>(array)) return CV_8U;
  if (py::isinstance<py::array_t<std::uint16_t>>(array)) return CV_16U;
  refuse(std::string(what) + " must hold uint8 (or uint16), not " +
         std::string(py::str(array.dtype())) + "; convert it, e.g. with .astype(numpy.uint8)");
}

/// Whether OpenCV can read rows and pixels where they are.
bool is_readable(const py::array& array, py::ssize_t pixel_bytes) {
  const bool channels =
      array.ndim() < 3 || array.shape(2) == 1 || array.strides(2) == array.itemsize();
  const bool columns = array.shape(1) <= 1 || array.strides(1) == pixel_bytes;
  const bool rows = array.shape(0) <= 1 || (array.strides(0) >= array.shape(1) * pixel_bytes &&
                                            array.strides(0) % array.itemsize() == 0);
  return channels && columns && rows;
}

bool fits(const OptionField& field, const py::handle& value) {
  if (std::holds_alternative<std::string*>(field.value)) return PyUnicode_Check(value.ptr());
  if (std::holds_alternative<bool*>(field.value)) return PyBool_Check(value.ptr());
  return !PyUnicode_Check(value.ptr()) && !PyBool_Check(value.ptr()) && PyNumber_Check(value.ptr());
}

}  // namespace

Picture picture_of(const py::object& object, const char* what) {
  Picture picture;
  picture.array = array_of(object, what);
  const int depth = depth_of(picture.array, what);
  const py::ssize_t dimensions = picture.array.ndim();
  const py::ssize_t channels = dimensions == 3 ? picture.array.shape(2) : 1;
  if (dimensions < 2 || dimensions > 3 || (channels != 1 && channels != 3 && channels != 4))
    refuse(std::string(what) +
           " must have the shape (height, width) or (height, width, 3), in BGR, not " +
           shape_text(picture.array));
  const py::ssize_t pixel_bytes = channels * picture.array.itemsize();
  if (!is_readable(picture.array, pixel_bytes)) {
    picture.array = py::module_::import("numpy").attr("ascontiguousarray")(picture.array);
    picture.in_place = false;
  }
  const py::array& array = picture.array;
  if (array.size() == 0) return picture;
  if (array.shape(0) > INT_MAX || array.shape(1) > INT_MAX)
    refuse(std::string(what) + " is too large: " + shape_text(array));
  const auto step = array.shape(0) > 1 ? static_cast<std::size_t>(array.strides(0))
                                       : std::size_t{cv::Mat::AUTO_STEP};
  picture.image = cv::Mat(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)),
                          CV_MAKETYPE(depth, static_cast<int>(channels)),
                          const_cast<void*>(array.data()), step);
  return picture;
}

Picture mask_of(const py::object& object) {
  if (object.is_none()) return {};
  if (!py::isinstance<py::array_t<bool>>(object)) return picture_of(object, "mask");
  Picture mask = picture_of(
      object.attr("astype")("uint8").attr("__mul__")(py::int_(255)).attr("astype")("uint8"),
      "mask");
  mask.in_place = false;
  return mask;
}

py::object to_array(const cv::Mat& matrix) {
  if (matrix.empty()) return py::none();
  auto* kept = new cv::Mat(matrix);
  const py::capsule owner(kept, [](void* mat) { delete static_cast<cv::Mat*>(mat); });
  const auto item = static_cast<py::ssize_t>(matrix.elemSize1());
  std::vector<py::ssize_t> shape{matrix.rows, matrix.cols};
  std::vector<py::ssize_t> strides{static_cast<py::ssize_t>(matrix.step[0]),
                                   static_cast<py::ssize_t>(matrix.elemSize())};
  if (matrix.channels() > 1) {
    shape.push_back(matrix.channels());
    strides.push_back(item);
  }
  const char* type = matrix.depth() == CV_8U    ? "u1"
                     : matrix.depth() == CV_16U ? "u2"
                     : matrix.depth() == CV_32F ? "f4"
                                                : "f8";
  py::array array(py::dtype(type), std::move(shape), std::move(strides), kept->data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array points_array(const std::vector<cv::Point2f>& points) {
  py::array_t<float> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
  for (std::size_t i = 0; i < points.size(); ++i) {
    array.mutable_at(i, 0) = points[i].x;
    array.mutable_at(i, 1) = points[i].y;
  }
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::object to_python(const std::string& json) {
  return py::module_::import("json").attr("loads")(py::str(json));
}

py::object number_or_none(double value) {
  return std::isfinite(value) ? py::object(py::float_(value)) : py::object(py::none());
}

std::string keyword_of(const std::string& option) {
  std::string keyword = option;
  std::ranges::replace(keyword, '.', '_');
  return keyword;
}

std::string option_text(const OptionField& field, const py::handle& value) {
  const std::string given = py::repr(value);
  if (!fits(field, value)) {
    const char* type = std::holds_alternative<bool*>(field.value)          ? "True or False"
                       : std::holds_alternative<std::string*>(field.value) ? "a string"
                                                                           : "a number";
    refuse("option " + field.name + " must be " + type + ", not " + given);
  }
  if (std::holds_alternative<std::string*>(field.value)) return value.cast<std::string>();
  if (std::holds_alternative<bool*>(field.value)) return value.cast<bool>() ? "true" : "false";
  if (PyIndex_Check(value.ptr()))
    return py::str(py::int_(py::reinterpret_borrow<py::object>(value)));
  return py::repr(py::float_(py::reinterpret_borrow<py::object>(value)));
}

void apply_keywords(const OptionList& list, const py::dict& keywords, const std::string& prefix) {
  for (const auto& [key, value] : keywords) {
    const auto keyword = key.cast<std::string>();
    const auto found = std::ranges::find_if(list.fields(), [&](const OptionField& field) {
      return keyword_of(field.name) == keyword || field.name == keyword ||
             keyword_of(field.name) == keyword_of(prefix) + keyword;
    });
    if (found == list.fields().end()) {
      std::vector<std::string> known;
      for (const OptionField& field : list.fields())
        if (field.name.starts_with(prefix))
          known.push_back(keyword_of(field.name.substr(prefix.size())));
        else
          known.push_back(keyword_of(field.name));
      const std::string nearest = nearest_word(keyword, known);
      throw UnknownOption(
          "there is no option '" + keyword + "'" +
          (nearest.empty() ? "; help() lists them all" : "; did you mean '" + nearest + "'?"));
    }
    try {
      list.set(found->name, option_text(*found, value));
    } catch (const Error& error) {
      // The library's sentence, with the name that was given.
      std::string message = error.what();
      if (const auto at = message.find(found->name); at != std::string::npos)
        message.replace(at, found->name.size(), keyword);
      throw Error(error.code(), message);
    }
  }
}

py::list describe_options(const OptionList& list, const std::string& prefix) {
  py::list described;
  for (const OptionField& field : list.fields()) {
    py::dict entry;
    entry["name"] = keyword_of(prefix + field.name);
    if (auto* const* flag = std::get_if<bool*>(&field.value)) entry["default"] = **flag;
    if (auto* const* whole = std::get_if<int*>(&field.value)) entry["default"] = **whole;
    if (auto* const* real = std::get_if<double*>(&field.value)) entry["default"] = **real;
    if (auto* const* word = std::get_if<std::string*>(&field.value)) entry["default"] = **word;
    entry["min"] = field.min;
    entry["max"] = field.max;
    entry["unit"] = field.unit;
    entry["choices"] = field.choices;
    entry["help"] = field.help;
    described.append(entry);
  }
  return described;
}

std::string with_options(const std::string& doc, const py::list& options) {
  std::string text = doc + "\n\nOptions (keywords):\n";
  for (const auto& entry : options) {
    const std::string range =
        py::isinstance<py::float_>(entry["default"]) ||
                (py::isinstance<py::int_>(entry["default"]) &&
                 !py::isinstance<py::bool_>(entry["default"]))
            ? std::string(py::str("{:g} to {:g}").format(entry["min"], entry["max"]))
            : "";
    const auto unit = entry["unit"].cast<std::string>();
    const std::string limits = range + (range.empty() || unit.empty() ? "" : " ") + unit;
    text += "  " + entry["name"].cast<std::string>() + "=" +
            std::string(py::repr(entry["default"])) + (limits.empty() ? "" : "  (" + limits + ")") +
            "\n      " + entry["help"].cast<std::string>() + "\n";
  }
  return text;
}

}  // namespace posevote::python
