// Taught views and sets of them as Python sees them.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "convert.hpp"
#include "posevote/recognize/recognizer.hpp"
#include "posevote/store/object_store.hpp"
#include "posevote/teach/teacher.hpp"

namespace posevote::python {

/// A view and the features it was made with.
struct PyView {
  TaughtView taught;
  FeatureRecord record;
};

/// Objects that recognition can look for, and the options that their features were made with.
struct PyModels {
  std::shared_ptr<const ModelSet> models;
  std::optional<FeatureRecord> record;
};

/// How a view is taught, from a call's arguments: a file's name or an array, and where the object
/// is.
struct Lesson {
  py::object picture, background, mask, roi, yaw_deg;
};

/// Throws what `teach_view` throws.
[[nodiscard]] PyView teach(const Lesson& lesson, const TeachOptions& options,
                           const std::string& version);

/// A set of objects from a mapping of names to lists of views. Throws Error{feature_mismatch}.
[[nodiscard]] PyModels make_models(const py::dict& objects);

/// A ModelSet, a mapping as above, or whatever has a method `load` that gives either.
[[nodiscard]] PyModels models_from(const py::object& object);

/// Version of this package: what a taught view's provenance says.
[[nodiscard]] const char* package_version();

}  // namespace posevote::python
