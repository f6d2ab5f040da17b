#include <pybind11/stl/filesystem.h>

#include "convert.hpp"
#include "posevote/image/frame_source.hpp"
#include "posevote/image/inputs.hpp"
#include "posevote/image/read_image.hpp"

namespace posevote::python {
namespace {

/// The frames of a video file, one after the other.
class Video {
 public:
  explicit Video(const std::filesystem::path& path)
      : source_(without_gil([&] { return open_video(path.string()); })) {}

  std::int64_t length() const { return source_->length(); }
  Frame next() {
    auto frame = without_gil([&] { return source_->next(); });
    if (!frame) throw py::stop_iteration();
    return std::move(*frame);
  }

 private:
  std::unique_ptr<FrameSource> source_;
};

void bind_video(py::module_& module) {
  py::class_<Frame>(module, "Frame", "A frame of a video.")
      .def_readonly("number", &Frame::number, "Counted from 0.")
      .def_readonly("time_s", &Frame::time_s, "Since the first frame, seconds.")
      .def_property_readonly(
          "image", [](const Frame& f) { return to_array(f.image); }, "H x W x 3, uint8, BGR.")
      .def(
          "to_dict",
          [](const Frame& f) {
            return py::dict(py::arg("frame") = f.number, py::arg("time_s") = f.time_s,
                            py::arg("width") = f.image.cols, py::arg("height") = f.image.rows);
          },
          "Without its pixels; names as in the lines of 'posevote recognize --json'.")
      .def("__repr__", [](const Frame& f) {
        return "Frame(number=" + std::to_string(f.number) + ", " + std::to_string(f.image.cols) +
               " x " + std::to_string(f.image.rows) + " px)";
      });
  py::class_<Video>(module, "Video",
                    "The frames of a video file: iterate over it, once.\n\n"
                    "path: the file. Raises UnreadableImageError, UnsupportedError in a build\n"
                    "without video. For one thread at a time.")
      .def(py::init<const std::filesystem::path&>(), py::arg("path"))
      .def_property_readonly("length", &Video::length,
                             "Number of frames as the file says; 0 when it does not.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Video::next);
}

/// (kind, path) of each picture, video or camera that an argument stands for.
std::vector<std::pair<std::string, std::string>> inputs_of(const std::string& argument) {
  std::vector<std::pair<std::string, std::string>> inputs;
  for (const Input& input : expand_input(argument))
    inputs.emplace_back(input.kind == InputKind::image   ? "image"
                        : input.kind == InputKind::video ? "video"
                                                         : "camera",
                        input.path);
  return inputs;
}

}  // namespace

void bind_images(py::module_& module) {
  bind_video(module);
  module.def("_expand_input", &inputs_of);
  module.def(
      "read_image",
      [](const std::filesystem::path& path) {
        return to_array(without_gil([&] { return read_image(path.string()); }));
      },
      py::arg("path"),
      "read_image(path) -> numpy.ndarray\n\n"
      "The picture in a file (JPEG, PNG, TIFF, WebP, BMP or PNM) as a read-only array: H x W, or\n"
      "H x W x 3 (BGR) or 4 (BGRA), uint8 or uint16, turned upright as its Exif data say.\n"
      "Raises UnreadableImageError.");
  module.def(
      "decode_image",
      [](const py::bytes& data, const std::string& name) {
        const std::string text = data;
        return to_array(without_gil([&] {
          return decode_image({text.begin(), text.end()}, name);
        }));
      },
      py::arg("data"), py::arg("name") = "picture",
      "decode_image(data, name='picture') -> numpy.ndarray\n\n"
      "The picture in these bytes, as read_image() gives it; `name` stands for it in messages.");
  module.def(
      "reads_in_place", [](const py::object& image) { return picture_of(image).in_place; },
      py::arg("image"),
      "reads_in_place(image) -> bool\n\n"
      "Whether the library reads this array where it lies. False: its pixels do not stand one "
      "after\n"
      "the other (e.g. image[..., ::-1]), so that each call makes a copy first.");
}

}  // namespace posevote::python
