#include <pybind11/stl/filesystem.h>
#include <opencv2/imgproc.hpp>

#include <cmath>

#include "features.hpp"
#include "posevote/image/read_image.hpp"
#include "posevote/teach/quality.hpp"
#include "store_json.hpp"
#include "views.hpp"

namespace posevote::python {
namespace {

bool is_path(const py::object& object) {
  return py::isinstance<py::str>(object) || py::hasattr(object, "__fspath__");
}

std::string path_text(const py::object& path) {
  return path.cast<std::filesystem::path>().string();
}

/// The picture that an argument names or is; empty: None.
Picture picture_or_file(const py::object& object, const char* what) {
  if (object.is_none()) return {};
  if (!is_path(object)) return picture_of(object, what);
  Picture picture;
  picture.image = read_image(path_text(object));
  return picture;
}

double yaw_from(const py::object& yaw_deg) {
  return yaw_deg.is_none() ? std::nan("") : yaw_deg.cast<double>();
}

std::optional<cv::Rect> rect_from(const py::object& roi) {
  if (roi.is_none()) return std::nullopt;
  const auto values = roi.cast<std::vector<int>>();
  if (values.size() != 4)
    throw Error(ErrorCode::invalid_argument, "roi must be (x, y, width, height) in pixels");
  return cv::Rect(values[0], values[1], values[2], values[3]);
}

const char* method_of(const ViewSource& source) {
  if (!source.mask.empty()) return "mask";
  if (!source.background.empty()) return "background";
  return source.roi ? "roi" : "whole";
}

ViewSource source_of(const Lesson& lesson, std::vector<Picture>& kept) {
  ViewSource source;
  kept.push_back(picture_or_file(lesson.picture, "picture"));
  kept.push_back(picture_or_file(lesson.background, "background"));
  kept.push_back(is_path(lesson.mask) ? picture_or_file(lesson.mask, "mask")
                                      : mask_of(lesson.mask));
  source.picture = kept[0].image;
  source.background = kept[1].image;
  source.mask = kept[2].image;
  source.roi = rect_from(lesson.roi);
  source.yaw_deg = yaw_from(lesson.yaw_deg);
  return source;
}

TeachOptions teach_options(const py::kwargs& keywords) {
  TeachOptions options;
  apply_keywords(list_options(options), keywords);
  return options;
}

/// What a database would say of it.
ViewSummary summary_of(const PyView& self) {
  const View& view = self.taught.view;
  ViewSummary summary;
  summary.id = view.id;
  summary.hash = view.hash;
  summary.yaw_deg = view.yaw_deg;
  summary.image_size = view.image_size;
  summary.features = static_cast<int>(view.features.size());
  summary.coverage = coverage(view);
  summary.method = self.taught.method;
  summary.provenance = self.taught.provenance;
  return summary;
}

std::string view_text(const PyView& self) {
  const View& view = self.taught.view;
  return "View(" + (view.id.empty() ? "" : "id='" + view.id + "', ") +
         std::to_string(view.image_size.width) + " x " + std::to_string(view.image_size.height) +
         " px, " + std::to_string(view.features.size()) + " features, method='" +
         self.taught.method + "')";
}

void bind_view(py::module_& module) {
  using Shared = std::shared_ptr<PyView>;
  py::class_<PyView, Shared>(module, "View",
                             "One taught picture of an object: its silhouette and features.\n\n"
                             "Coordinates are pixels of that picture.")
      .def_property_readonly(
          "id", [](const PyView& v) { return v.taught.view.id; },
          "Unique within the object, given by the database; '' before.")
      .def_property_readonly(
          "hash", [](const PyView& v) { return v.taught.view.hash; },
          "Content hash: equal for equal content; '' before it is stored.")
      .def_property_readonly(
          "yaw_deg", [](const PyView& v) { return number_or_none(v.taught.view.yaw_deg); },
          "Turn about the vertical axis, degrees; None: unknown.")
      .def_property_readonly(
          "image_size",
          [](const PyView& v) {
            const cv::Size size = v.taught.view.image_size;
            return py::make_tuple(size.width, size.height);
          },
          "(width, height), px.")
      .def_property_readonly(
          "outline", [](const PyView& v) { return points_array(v.taught.view.outline); },
          "The silhouette, a polygon: N x 2, float32, px.")
      .def_property_readonly(
          "centre",
          [](const PyView& v) {
            const cv::Point2f centre = v.taught.view.centre;
            return py::make_tuple(centre.x, centre.y);
          },
          "Centroid of the silhouette, (x, y), px.")
      .def_property_readonly(
          "features", [](const Shared& v) { return share(v, v->taught.view.features); },
          "The Features inside the silhouette.")
      .def_property_readonly(
          "picture", [](const PyView& v) { return to_array(v.taught.view.picture); },
          "H x W x 3, uint8, BGR; None when it was not loaded.")
      .def_property_readonly(
          "mask", [](const PyView& v) { return to_array(v.taught.view.mask); },
          "H x W, uint8, 255 where the object is; None when not loaded.")
      .def_property_readonly(
          "coverage", [](const PyView& v) { return coverage(v.taught.view); },
          "Share of the picture that the object covers.")
      .def_property_readonly(
          "signature", [](const PyView& v) { return v.record.signature; },
          "Kind of its features, e.g. 'surf64 1'.")
      .def_property_readonly(
          "method", [](const PyView& v) { return v.taught.method; },
          "How the object was found: 'background', 'mask', 'roi' or 'whole'.")
      .def_property_readonly(
          "source", [](const PyView& v) { return v.taught.provenance.source; },
          "File or camera that it comes from.")
      .def_property_readonly(
          "taught_at", [](const PyView& v) { return v.taught.provenance.taught_at; },
          "When, UTC, ISO 8601; '' before it is stored.")
      .def_property_readonly(
          "version", [](const PyView& v) { return v.taught.provenance.version; },
          "Version of posevote that taught it.")
      .def(
          "to_dict", [](const PyView& v) { return to_python(to_line(view_json(summary_of(v)))); },
          "What 'posevote objects show --json' says of it, but for the object's name.")
      .def("__repr__", &view_text);
}

}  // namespace

PyView teach(const Lesson& lesson, const TeachOptions& options, const std::string& version) {
  std::vector<Picture> kept;
  const ViewSource source = source_of(lesson, kept);
  PyView view;
  if (is_path(lesson.picture)) {
    view.taught.provenance.source = path_text(lesson.picture);
    view.taught.picture = read_bytes(view.taught.provenance.source);
  }
  view.taught.provenance.version = version;
  view.taught.method = method_of(source);
  view.taught.view = without_gil([&] { return teach_view(source, options); });
  view.record = record_features(options.feature);
  return view;
}

PyModels models_from(const py::object& object) {
  if (py::isinstance<PyModels>(object)) return object.cast<PyModels>();
  if (py::isinstance<py::dict>(object)) return make_models(object.cast<py::dict>());
  if (py::hasattr(object, "load")) return models_from(object.attr("load")());
  throw Error(ErrorCode::invalid_argument,
              "models must be a ModelSet, an ObjectStore or a mapping of names to views, not " +
                  std::string(py::str(py::type::of(object).attr("__name__"))));
}

PyModels make_models(const py::dict& objects) {
  PyModels made;
  std::vector<ObjectModel> all;
  for (const auto& [name, views] : objects) {
    ObjectModel object;
    object.name = name.cast<std::string>();
    for (const auto& item : views) {
      const auto view = item.cast<std::shared_ptr<PyView>>();
      if (made.record && made.record->signature != view->record.signature)
        throw Error(ErrorCode::feature_mismatch, "views with features '" + made.record->signature +
                                                     "' and '" + view->record.signature +
                                                     "' must not be mixed");
      if (!made.record) made.record = view->record;
      object.views.emplace_back(view, &view->taught.view);
    }
    all.push_back(std::move(object));
  }
  made.models =
      std::make_shared<const ModelSet>(made.record ? made.record->signature : "", std::move(all));
  return made;
}

void bind_teaching(py::module_& module) {
  bind_view(module);
  module.def(
      "teach_view",
      [](const py::object& picture, const py::object& background, const py::object& mask,
         const py::object& roi, const py::object& yaw_deg, const py::kwargs& keywords) {
        return std::make_shared<PyView>(teach({picture, background, mask, roi, yaw_deg},
                                              teach_options(keywords), package_version()));
      },
      py::arg("picture"), py::kw_only(), py::arg("background") = py::none(),
      py::arg("mask") = py::none(), py::arg("roi") = py::none(), py::arg("yaw_deg") = py::none(),
      with_options("teach_view(picture, *, background=None, mask=None, roi=None, yaw_deg=None, "
                   "**options) -> View\n\n"
                   "Make a View of an object from a picture of it.\n\n"
                   "picture: array (uint8, H x W or H x W x 3 in BGR) or a file's name.\n"
                   "background: the same scene without the object; the difference is the object.\n"
                   "mask: H x W, uint8 or bool: the object is where it is bright.\n"
                   "roi: (x, y, width, height), px: the object fills this rectangle.\n"
                   "None of them: the whole picture is the object, or what is not transparent.\n"
                   "yaw_deg: its turn about the vertical axis.\n"
                   "Other threads run meanwhile. Raises UnusableViewError with advice when no "
                   "object is found.",
                   describe_defaults<TeachOptions>())
          .c_str());
  module.def(
      "find_object",
      [](const py::object& picture, const py::object& background, const py::kwargs& keywords) {
        std::vector<Picture> kept;
        const ViewSource source =
            source_of({picture, background, py::none(), py::none(), py::none()}, kept);
        SegmentOptions options;
        apply_keywords(list_options(options), keywords);
        return to_array(without_gil([&] { return find_object(source, options); }));
      },
      py::arg("picture"), py::arg("background"),
      with_options("find_object(picture, background, **options) -> numpy.ndarray\n\n"
                   "Where is the object? H x W, uint8, 255 on what is in `picture` but not in "
                   "`background`, its\n"
                   "shadow left out. Raises UnusableViewError with advice when there is nothing.",
                   describe_defaults<SegmentOptions>())
          .c_str());
  module.def("_teach_options", [] { return describe_defaults<TeachOptions>(); });
  module.def("_segment_options", [] { return describe_defaults<SegmentOptions>(); });
}

}  // namespace posevote::python
