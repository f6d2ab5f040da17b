// The Python module posevote._core: converts, calls the library, converts back.
#include "convert.hpp"
#include "views.hpp"

namespace posevote::python {
namespace {

py::object error_class(const char* name) {
  return py::module_::import("posevote.errors").attr(name);
}

void raise(const py::object& type, const std::string& message) {
  // Names in messages may hold bytes that are not UTF-8.
  PyObject* text =
      PyUnicode_DecodeUTF8(message.data(), static_cast<py::ssize_t>(message.size()), "replace");
  PyErr_SetObject(type.ptr(), text);
  Py_XDECREF(text);
}

void translate(std::exception_ptr pointer) {
  if (!pointer) return;
  try {
    std::rethrow_exception(pointer);
  } catch (const UnknownOption& error) {
    raise(error_class("OptionError"), error.what());
  } catch (const Error& error) {
    const py::object classes = error_class("CLASSES");
    raise(classes[py::str(to_string(error.code()))], error.what());
  }
}

std::vector<std::string> error_codes() {
  std::vector<std::string> codes;
  for (int i = 0; std::string(to_string(static_cast<ErrorCode>(i))) != "unknown"; ++i)
    codes.emplace_back(to_string(static_cast<ErrorCode>(i)));
  return codes;
}

}  // namespace

const char* package_version() {
  return POSEVOTE_VERSION;
}

}  // namespace posevote::python

PYBIND11_MODULE(_core, module) {
  using namespace posevote::python;
  py::options options;
  options.disable_function_signatures();
  module.attr("__version__") = POSEVOTE_VERSION;
  py::register_exception_translator(&translate);
  module.def("_error_codes", &error_codes);
  bind_images(module);
  bind_features(module);
  bind_teaching(module);
  bind_results(module);
  bind_recognition(module);
  bind_summaries(module);
  bind_store(module);
  bind_evaluation(module);
}
