#include "posevote/render/annotate.hpp"
#include "views.hpp"

namespace posevote::python {
namespace {

std::shared_ptr<PyView> view_of(const PyModels& models, const std::shared_ptr<const View>& view) {
  auto made = std::make_shared<PyView>();
  made->taught.view = *view;
  cv::Mat floats;
  view->features.descriptors.convertTo(floats, CV_32F);
  made->taught.view.features.descriptors = floats;
  if (models.record) made->record = *models.record;
  return made;
}

void bind_models(py::module_& module) {
  py::class_<PyModels, std::shared_ptr<PyModels>>(
      module, "ModelSet",
      "An immutable set of objects: what recognition looks for.\n\n"
      "Made from a mapping of names to lists of View, or by ObjectStore.load().")
      .def(py::init([](const py::dict& objects) { return make_models(objects); }),
           py::arg("objects"))
      .def_property_readonly(
          "names",
          [](const PyModels& self) {
            std::vector<std::string> names;
            for (const auto& object : self.models->objects()) names.push_back(object.name);
            return names;
          },
          "Names of the objects.")
      .def_property_readonly(
          "signature", [](const PyModels& self) { return self.models->signature(); },
          "Kind of the features, e.g. 'surf64 1'; '' of an empty set.")
      .def_property_readonly(
          "feature_count", [](const PyModels& self) { return self.models->feature_count(); },
          "Features of all views together.")
      .def(
          "views",
          [](const PyModels& self, const std::string& name) {
            py::list views;
            for (const auto& object : self.models->objects())
              if (object.name == name) {
                for (const auto& view : object.views) views.append(view_of(self, view));
                return views;
              }
            throw Error(ErrorCode::not_found, "there is no object '" + name + "'");
          },
          py::arg("name"), "views(name) -> list[View]\n\nThe object's views. Raises NotFoundError.")
      .def("__len__", [](const PyModels& self) { return self.models->objects().size(); })
      .def("__repr__", [](const PyModels& self) {
        return "ModelSet(" + std::to_string(self.models->objects().size()) + " objects, " +
               std::to_string(self.models->views().size()) + " views, " +
               std::to_string(self.models->feature_count()) + " features '" +
               self.models->signature() + "')";
      });
}

RecognizeOptions options_for(const PyModels& models, const std::string& preset,
                             const py::kwargs& keywords) {
  RecognizeOptions options = make_preset(preset);
  if (models.record) options.feature = recorded_options(*models.record);
  apply_keywords(list_options(options), keywords);
  return options;
}

py::dict settings_of(const std::string& preset, const std::vector<std::string>& settings) {
  RecognizeOptions options = make_preset(preset);
  const OptionList list = list_options(options);
  py::dict keywords;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw Error(ErrorCode::invalid_argument, "--set needs NAME=VALUE, not '" + setting + "'");
    const std::string name = setting.substr(0, equals);
    list.set(name, setting.substr(equals + 1));
    for (const auto& entry : describe_options(list))
      if (entry["name"].cast<std::string>() == keyword_of(name))
        keywords[entry["name"]] = entry["default"];
  }
  return keywords;
}

void bind_recognizer(py::module_& module) {
  py::class_<Recognizer, std::shared_ptr<Recognizer>>(
      module, "Recognizer",
      with_options(
          "Finds taught objects in pictures.\n\n"
          "models: a ModelSet, an ObjectStore (what it holds now), or a mapping of names to lists "
          "of\n"
          "View. preset: see preset_names(); keywords change single options of it.\n\n"
          "recognize() may be called from many threads while set_models() swaps the objects.",
          describe_defaults<RecognizeOptions>())
          .c_str())
      .def(py::init([](const py::object& objects, const std::string& preset,
                       const py::kwargs& keywords) {
             const PyModels models = models_from(objects);
             const RecognizeOptions options = options_for(models, preset, keywords);
             return without_gil(
                 [&] { return std::make_shared<Recognizer>(models.models, options); });
           }),
           py::arg("models"), py::kw_only(), py::arg("preset") = "default")
      .def(
          "recognize",
          [](const Recognizer& self, const py::object& image) {
            const Picture picture = picture_of(image);
            return without_gil(
                [&] { return std::make_shared<RecognitionResult>(self.recognize(picture.image)); });
          },
          py::arg("image"),
          "recognize(image) -> Recognition\n\n"
          "Find the objects in a picture: uint8 (or uint16) array, H x W (grey) or H x W x 3 "
          "(BGR),\n"
          "read in place. Returns a Recognition; nothing found is one without detections. Other\n"
          "threads run meanwhile. Raises InvalidArgumentError for other arrays.")
      .def(
          "set_models",
          [](Recognizer& self, const py::object& objects) {
            const PyModels models = models_from(objects);
            without_gil([&] { self.set_models(models.models); });
          },
          py::arg("models"),
          "set_models(models) -> None\n\n"
          "Look for these objects from now on; a running call ends with those it began with.\n"
          "Raises FeatureMismatchError.")
      .def_property_readonly(
          "models",
          [](const Recognizer& self) {
            return PyModels{self.models(), record_features(self.options().feature)};
          },
          "The ModelSet that it looks for.")
      .def_property_readonly(
          "options",
          [](const Recognizer& self) {
            RecognizeOptions options = self.options();
            py::dict values;
            for (const auto& entry : describe_options(list_options(options)))
              values[entry["name"]] = entry["default"];
            return values;
          },
          "All options with their present values, by keyword.")
      .def("__repr__", [](const Recognizer& self) {
        return "Recognizer(" + std::to_string(self.models()->objects().size()) + " objects, " +
               std::to_string(self.models()->views().size()) + " views)";
      });
}

}  // namespace

void bind_recognition(py::module_& module) {
  bind_models(module);
  bind_recognizer(module);
  module.def("preset_names", &preset_names,
             "preset_names() -> list[str]\n\nNames of the presets of Recognizer and evaluate.");
  module.def("_settings", &settings_of,
             "_settings(preset, settings) -> dict\n\nNAME=VALUE texts as keywords for Recognizer.");
  module.def("_recognize_options", [](const std::string& preset) {
    RecognizeOptions options = make_preset(preset);
    return describe_options(list_options(options));
  });
  module.def(
      "annotate",
      [](const py::object& image, const RecognitionResult& result) {
        const Picture picture = picture_of(image);
        return to_array(without_gil([&] { return annotate(picture.image, result); }));
      },
      py::arg("image"), py::arg("result"),
      "annotate(image, result) -> numpy.ndarray\n\n"
      "A BGR copy of the picture with outline, name, confidence and matched key points of every\n"
      "detection drawn on it (H x W x 3, uint8).");
}

}  // namespace posevote::python
