#include "features.hpp"

#include <cstring>

namespace posevote::python {
namespace {

using Shared = std::shared_ptr<Features>;

/// Not made before it is needed: the package can be imported, e.g. for its stubs, without numpy.
py::dtype keypoint_type() {
  static const bool known = [] {
    PYBIND11_NUMPY_DTYPE(Keypoint, x, y, scale, angle, response, laplacian);
    return true;
  }();
  static_cast<void>(known);
  return py::dtype::of<Keypoint>();
}

py::array keypoints_of(const py::object& self) {
  auto& features = self.cast<Features&>();
  py::array array(keypoint_type(), {features.size()}, {sizeof(Keypoint)}, features.keypoints.data(),
                  self);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array points_of(const py::object& self) {
  auto& features = self.cast<Features&>();
  const float* first = features.empty() ? nullptr : &features.keypoints.front().x;
  py::array array(py::dtype::of<float>(), {features.size(), std::size_t{2}},
                  {sizeof(Keypoint), sizeof(float)}, first, self);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::object descriptors_of(const Features& features) {
  if (features.empty())
    return py::array_t<float>(std::vector<py::ssize_t>{0, features.descriptors.cols});
  return to_array(features.descriptors);
}

/// SURF alone, or SIFT: an extractor with its options as keywords.
class FeatureExtractor {
 public:
  FeatureExtractor(const std::string& kind, const py::kwargs& keywords) {
    options_.kind = kind;
    apply_keywords(list_of(options_), keywords, kind + ".");
    extractor_ = make_extractor(options_);
  }

  Shared extract(const py::object& image, const py::object& mask) const {
    const Picture picture = picture_of(image), area = mask_of(mask);
    return without_gil(
        [&] { return std::make_shared<Features>(extractor_->extract(picture.image, area.image)); });
  }

  std::string text() const {
    FeatureOptions options = options_, defaults;
    const OptionList list = list_of(options), standard = list_of(defaults);
    std::string text = options_.kind == "surf" ? "Surf(" : "Sift(";
    bool first = true;
    for (std::size_t i = 0; i < list.fields().size(); ++i) {
      const OptionField& field = list.fields()[i];
      if (field.name == "kind" || field.text() == standard.fields()[i].text()) continue;
      const std::string dotted = options_.kind + ".";
      text += (first ? "" : ", ") +
              (field.name.starts_with(dotted) ? field.name.substr(dotted.size()) : field.name) +
              "=" + field.text();
      first = false;
    }
    return text + ")";
  }

  const FeatureOptions& options() const { return options_; }

 private:
  static OptionList list_of(FeatureOptions& options) { return list_options(options); }

  FeatureOptions options_;
  std::shared_ptr<const Extractor> extractor_;
};

struct Surf : FeatureExtractor {
  explicit Surf(const py::kwargs& keywords) : FeatureExtractor("surf", keywords) {}
};
struct Sift : FeatureExtractor {
  explicit Sift(const py::kwargs& keywords) : FeatureExtractor("sift", keywords) {}
};

/// The options of the extractor `kind`, without what the other kind needs.
py::list extractor_options(const std::string& kind) {
  py::list wanted;
  for (const auto& entry : describe_defaults<FeatureOptions>()) {
    auto name = entry["name"].cast<std::string>();
    const std::string own = kind + "_", other = kind == "surf" ? "sift_" : "surf_";
    if (name == "kind" || name.starts_with(other)) continue;
    if (kind != "surf" && name == "double_below_px") continue;
    if (name.starts_with(own)) entry["name"] = name.substr(own.size());
    wanted.append(entry);
  }
  return wanted;
}

template <class Kind>
void bind_extractor(py::module_& module, const char* name, const char* kind,
                    const std::string& doc) {
  py::class_<Kind>(module, name, with_options(doc, extractor_options(kind)).c_str())
      .def(py::init<const py::kwargs&>())
      .def("detect_and_compute", &FeatureExtractor::extract, py::arg("image"),
           py::arg("mask") = py::none(),
           "detect_and_compute(image, mask=None) -> Features\n\n"
           "Find the features of a picture.\n\n"
           "image: uint8 (or uint16) array, H x W (grey) or H x W x 3 (BGR); read in place.\n"
           "mask: H x W, uint8 or bool; key points where it is 0 are left out.\n"
           "Returns Features, strongest first; also from a picture without any.\n"
           "Other threads run meanwhile. Raises InvalidArgumentError for other arrays.")
      .def("__repr__", &FeatureExtractor::text)
      .def_property_readonly(
          "signature", [](const Kind& self) { return self.options().signature(); },
          "Only features of equal signature can be compared, e.g. 'surf64 1'.");
}

}  // namespace

void bind_features(py::module_& module) {
  py::class_<Features, Shared>(
      module, "Features",
      "Key points and one descriptor each, in one order, strongest first.\n\n"
      "len() is their number; unpacking gives (keypoints, descriptors).")
      .def_property_readonly(
          "keypoints", &keypoints_of,
          "Structured array of length N: x, y (px; (0, 0) is the centre of the top-left pixel, y\n"
          "down), scale (sigma of the detecting filter, px), angle (radians in [-pi, pi), "
          "clockwise\n"
          "as seen), response (strength), laplacian (+1 dark blob, -1 bright, 0 not known).")
      .def_property_readonly("points", &points_of, "x and y alone: N x 2, float32, px.")
      .def_property_readonly("descriptors", &descriptors_of,
                             "N x 64 (SURF) or N x 128 (SIFT), float32, rows of length 1.")
      .def("__len__", &Features::size)
      .def("__iter__",
           [](const py::object& self) {
             return py::iter(py::make_tuple(keypoints_of(self), self.attr("descriptors")));
           })
      .def(
          "to_dict",
          [](const py::object& self) {
            py::dict dict;
            dict["keypoints"] = keypoints_of(self).attr("tolist")();
            dict["descriptors"] = self.attr("descriptors").attr("tolist")();
            return dict;
          },
          "Plain lists, for JSON.")
      .def("__repr__",
           [](const Features& self) {
             return "Features(" + std::to_string(self.size()) + " key points, descriptors " +
                    std::to_string(self.size()) + " x " + std::to_string(self.descriptors.cols) +
                    ")";
           })
      .def(py::pickle(
          [](const Features& self) {
            const auto* points = reinterpret_cast<const char*>(self.keypoints.data());
            const auto* rows = self.descriptors.ptr<char>();
            return py::make_tuple(
                py::bytes(points, self.size() * sizeof(Keypoint)), self.descriptors.cols,
                py::bytes(rows, self.descriptors.total() * self.descriptors.elemSize()));
          },
          [](const py::tuple& state) {
            const auto points = state[0].cast<std::string>(), rows = state[2].cast<std::string>();
            const std::size_t count = points.size() / sizeof(Keypoint);
            const auto columns = state[1].cast<std::size_t>();
            if (points.size() != count * sizeof(Keypoint) ||
                rows.size() != count * columns * sizeof(float))
              throw Error(ErrorCode::invalid_argument, "these pickled features are damaged");
            auto features = std::make_shared<Features>();
            features->keypoints.resize(count);
            std::memcpy(features->keypoints.data(), points.data(), points.size());
            features->descriptors.create(static_cast<int>(count), static_cast<int>(columns),
                                         CV_32F);
            std::memcpy(features->descriptors.data, rows.data(), rows.size());
            return features;
          }));

  bind_extractor<Surf>(module, "Surf", "surf",
                       "Speeded-Up Robust Features (Bay et al., CVIU 110(3), 2008).");
  bind_extractor<Sift>(module, "Sift", "sift",
                       "OpenCV's SIFT (Lowe 2004) with RootSIFT descriptors.");
  module.def("_extractor_options", &extractor_options);
}

}  // namespace posevote::python
