#include <pybind11/functional.h>
#include <pybind11/stl/filesystem.h>

#include "convert.hpp"
#include "posevote/evaluate/method.hpp"
#include "posevote/evaluate/results.hpp"

namespace posevote::python {
namespace {

using Shared = std::shared_ptr<Evaluation>;

/// The options of both as pairs that `make_method` reads.
std::vector<std::pair<std::string, std::string>> settings_from(const std::string& preset,
                                                               const py::kwargs& keywords) {
  RecognizeOptions recognize = make_preset(preset);
  TeachOptions teach;
  OptionList all;
  recognize.describe(all);
  all.group("teach", teach);
  apply_keywords(all, keywords);  // refuses what is wrong
  std::vector<std::pair<std::string, std::string>> settings;
  for (const auto& [key, value] : keywords) {
    const auto keyword = key.cast<std::string>();
    for (const OptionField& field : all.fields())
      if (keyword_of(field.name) == keyword || field.name == keyword)
        settings.emplace_back(field.name, field.text());
  }
  return settings;
}

Shared run(const std::filesystem::path& dataset, const std::string& preset,
           const std::vector<std::string>& groups, int limit, int jobs, const py::object& negatives,
           const py::object& progress, const py::kwargs& keywords) {
  Method method = make_method(preset, settings_from(preset, keywords));
  method.jobs = jobs;
  if (!progress.is_none())
    method.progress =
        progress.cast<std::function<void(const std::string&, std::size_t, std::size_t)>>();
  std::filesystem::path without;
  if (!negatives.is_none()) without = negatives.cast<std::filesystem::path>();
  return without_gil([&] {
    const Dataset wanted = select_tests(load_dataset(dataset), groups, limit);
    const Dataset others = without.empty() ? Dataset() : load_dataset(without);
    return std::make_shared<Evaluation>(TaughtMethod(wanted, method).evaluate(wanted, others));
  });
}

std::string summary_text(const Summary& s) {
  return "Summary(name=" + std::string(py::repr(py::str(s.name))) +
         ", images=" + std::to_string(s.images) + ", asked=" + std::to_string(s.asked) +
         ", right=" + std::to_string(s.right) +
         ", false_positives=" + std::to_string(s.false_positives) + ")";
}

py::dict summary_dict(const Summary& s) {
  py::dict dict;
  dict["name"] = s.name;
  dict["images"] = s.images;
  dict["unreadable"] = s.unreadable;
  dict["asked"] = s.asked;
  dict["right"] = s.right;
  dict["false_positives"] = s.false_positives;
  dict["twins"] = s.twins;
  dict["ignored"] = s.ignored;
  dict["recall"] = number_or_none(s.recall());
  dict["precision"] = number_or_none(s.precision());
  dict["median_ms"] = number_or_none(s.total.median_ms);
  return dict;
}

}  // namespace

void bind_evaluation(py::module_& module) {
  py::class_<Summary>(module, "Summary", "How good recognition was on a group of pictures.")
      .def_readonly("name", &Summary::name, "Of the group of pictures.")
      .def_readonly("images", &Summary::images, "Pictures.")
      .def_readonly("unreadable", &Summary::unreadable, "Pictures that could not be read.")
      .def_readonly("asked", &Summary::asked, "Objects that were to be found.")
      .def_readonly("right", &Summary::right,
                    "Objects found: the right name, boxes overlap by half.")
      .def_readonly("false_positives", &Summary::false_positives, "Everything else reported.")
      .def_readonly("twins", &Summary::twins,
                    "The name of an object that can hardly be told apart.")
      .def_readonly("ignored", &Summary::ignored, "Neither asked for nor wrong.")
      .def_property_readonly(
          "recall", [](const Summary& s) { return number_or_none(s.recall()); },
          "right / asked; None when nothing was asked.")
      .def_property_readonly(
          "precision", [](const Summary& s) { return number_or_none(s.precision()); },
          "right / (right + false positives); None without any.")
      .def_property_readonly(
          "median_ms", [](const Summary& s) { return number_or_none(s.total.median_ms); },
          "Median time of recognition, ms; None when no picture was read.")
      .def("to_dict", &summary_dict)
      .def("__repr__", &summary_text);
  py::class_<Evaluation, Shared>(module, "Evaluation", "Result of evaluate().")
      .def_property_readonly(
          "name", [](const Evaluation& e) { return e.dataset.name; }, "Of the data set.")
      .def_readonly("objects", &Evaluation::objects, "Objects taught.")
      .def_readonly("views", &Evaluation::views, "Views taught.")
      .def_readonly("features", &Evaluation::features, "Features of all views.")
      .def_property_readonly(
          "refused",
          [](const Evaluation& e) {
            py::list refused;
            for (const RefusedView& view : e.refused)
              refused.append(py::make_tuple(view.object, view.image, view.reason));
            return refused;
          },
          "(object, image, reason) of each view that could not be taught.")
      .def_property_readonly(
          "summary",
          [](const Evaluation& e) { return summarize(e.dataset.name, e.dataset, e.outcomes); },
          "Summary of the whole set.")
      .def_property_readonly(
          "groups", [](const Evaluation& e) { return summarize_groups(e.dataset, e.outcomes); },
          "Summary of each group, in the order of the data set.")
      .def(
          "to_dict", [](const Evaluation& e) { return to_python(to_json(e)); },
          "What 'posevote evaluate --json' prints.")
      .def("__repr__", [](const Evaluation& e) {
        return "Evaluation(" + std::to_string(e.objects) + " objects, " + std::to_string(e.views) +
               " views, " + summary_text(summarize(e.dataset.name, e.dataset, e.outcomes)) + ")";
      });
  module.def("evaluate", &run, py::arg("dataset"), py::kw_only(), py::arg("preset") = "default",
             py::arg("groups") = std::vector<std::string>(), py::arg("limit") = 0,
             py::arg("jobs") = 0, py::arg("negatives") = py::none(),
             py::arg("progress") = py::none(),
             "evaluate(dataset, *, preset='default', groups=[], limit=0, jobs=0, negatives=None, "
             "progress=None, **options) -> Evaluation\n\n"
             "Teach a data set's objects, recognise its tests and score what was found.\n\n"
             "dataset: folder with a dataset.json. groups: only these (wildcards * and ?).\n"
             "limit: only so many tests, evenly spread; 0: all. jobs: pictures at a time; 0: one\n"
             "for each core. negatives: a data set without any of the objects.\n"
             "progress: called as progress(task, done, total).\n"
             "Keywords change options of the preset; teach_... are the teacher's.\n"
             "Returns an Evaluation. Other threads run meanwhile.");
}

}  // namespace posevote::python
