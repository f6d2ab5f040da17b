// What a database says of its objects and views, and what became of a change.
#include "posevote/store/transfer.hpp"
#include "store_json.hpp"
#include "views.hpp"

namespace posevote::python {
namespace {

void bind_object_summary(py::module_& module) {
  py::class_<ObjectSummary>(module, "ObjectSummary", "An object of a database.")
      .def_readonly("name", &ObjectSummary::name, "What it is called.")
      .def_readonly("views", &ObjectSummary::views, "Number of its views.")
      .def_readonly("features", &ObjectSummary::features, "Features of all its views.")
      .def_readonly("first_taught_at", &ObjectSummary::first_taught_at, "UTC, ISO 8601.")
      .def_readonly("last_taught_at", &ObjectSummary::last_taught_at, "UTC, ISO 8601.")
      .def(
          "to_dict", [](const ObjectSummary& o) { return to_python(to_line(object_json(o))); },
          "As in the lines of 'posevote objects list --json'.")
      .def("__repr__", [](const ObjectSummary& o) {
        return "ObjectSummary(name=" + std::string(py::repr(py::str(o.name))) +
               ", views=" + std::to_string(o.views) + ", features=" + std::to_string(o.features) +
               ")";
      });
}

void bind_view_summary(py::module_& module) {
  py::class_<ViewSummary>(module, "ViewSummary", "A view of a database, without its pictures.")
      .def_readonly("id", &ViewSummary::id, "Its name within the object.")
      .def_readonly("hash", &ViewSummary::hash, "Content hash: equal for equal content.")
      .def_property_readonly(
          "yaw_deg", [](const ViewSummary& v) { return number_or_none(v.yaw_deg); },
          "Turn about the vertical axis, degrees; None: unknown.")
      .def_property_readonly(
          "image_size",
          [](const ViewSummary& v) {
            return py::make_tuple(v.image_size.width, v.image_size.height);
          },
          "(width, height), px.")
      .def_readonly("features", &ViewSummary::features, "Number of its features.")
      .def_readonly("coverage", &ViewSummary::coverage,
                    "Share of the picture that the object covers.")
      .def_readonly("method", &ViewSummary::method, "How the object was found.")
      .def_property_readonly(
          "source", [](const ViewSummary& v) { return v.provenance.source; },
          "File or camera that it comes from.")
      .def_property_readonly(
          "taught_at", [](const ViewSummary& v) { return v.provenance.taught_at; },
          "UTC, ISO 8601.")
      .def_property_readonly(
          "version", [](const ViewSummary& v) { return v.provenance.version; },
          "Version of posevote that taught it.")
      .def(
          "to_dict", [](const ViewSummary& v) { return to_python(to_line(view_json(v))); },
          "As in the lines of 'posevote objects show --json', but for the object's name.")
      .def("__repr__", [](const ViewSummary& v) {
        return "ViewSummary(id='" + v.id + "', " + std::to_string(v.features) +
               " features, source=" + std::string(py::repr(py::str(v.provenance.source))) + ")";
      });
}

}  // namespace

void bind_summaries(py::module_& module) {
  bind_object_summary(module);
  bind_view_summary(module);
  py::class_<AddResult>(module, "AddResult", "What became of a view that was added.")
      .def_readonly("id", &AddResult::id, "Id of the view.")
      .def_readonly("added", &AddResult::added, "False: it was there already, under this id.")
      .def("to_dict",
           [](const AddResult& r) {
             return py::dict(py::arg("id") = r.id, py::arg("added") = r.added);
           })
      .def("__repr__", [](const AddResult& r) {
        return "AddResult(id='" + r.id + "', added=" + (r.added ? "True" : "False") + ")";
      });
  py::class_<TransferResult>(module, "TransferResult", "What was copied.")
      .def_readonly("objects", &TransferResult::objects, "Objects copied.")
      .def_readonly("views_added", &TransferResult::views_added,
                    "Views that were not there before.")
      .def_readonly("views_known", &TransferResult::views_known, "Views that were there already.")
      .def("to_dict",
           [](const TransferResult& r) {
             return py::dict(py::arg("objects") = r.objects, py::arg("views_added") = r.views_added,
                             py::arg("views_known") = r.views_known);
           })
      .def("__repr__", [](const TransferResult& r) {
        return "TransferResult(objects=" + std::to_string(r.objects) +
               ", views_added=" + std::to_string(r.views_added) +
               ", views_known=" + std::to_string(r.views_known) + ")";
      });
}

}  // namespace posevote::python
