// What was found in a picture, as Python sees it.
#include "convert.hpp"
#include "posevote/recognize/recognizer.hpp"

namespace posevote::python {
namespace {

using SharedResult = std::shared_ptr<RecognitionResult>;

py::array homography_of(const Detection& detection) {
  return to_array(cv::Mat(detection.scene_from_view, true));
}

py::tuple box_of(const Detection& detection) {
  const cv::Rect2d& box = detection.box;
  return py::make_tuple(box.x, box.y, box.width, box.height);
}

/// N x 2 x 2: the point in the view, the point in the scene.
py::array matches_of(const Detection& detection) {
  py::array_t<float> array(
      {static_cast<py::ssize_t>(detection.matches.size()), py::ssize_t{2}, py::ssize_t{2}});
  for (std::size_t i = 0; i < detection.matches.size(); ++i) {
    const MatchedPoint& match = detection.matches[i];
    array.mutable_at(i, 0, 0) = match.view.x;
    array.mutable_at(i, 0, 1) = match.view.y;
    array.mutable_at(i, 1, 0) = match.scene.x;
    array.mutable_at(i, 1, 1) = match.scene.y;
  }
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

std::string detection_text(const Detection& detection) {
  char numbers[160];
  std::snprintf(numbers, sizeof numbers,
                "confidence=%.3f, inliers=%d, box=(%.1f, %.1f, %.1f, %.1f))", detection.confidence,
                detection.inliers, detection.box.x, detection.box.y, detection.box.width,
                detection.box.height);
  return "Detection(object=" + std::string(py::repr(py::str(detection.object))) + ", view='" +
         detection.view + "', " + numbers;
}

py::tuple detection_state(const Detection& d) {
  std::vector<double> homography(d.scene_from_view.val, d.scene_from_view.val + 9);
  std::vector<float> outline, matches;
  for (const cv::Point2f& p : d.outline) outline.insert(outline.end(), {p.x, p.y});
  for (const MatchedPoint& m : d.matches)
    matches.insert(matches.end(), {m.view.x, m.view.y, m.scene.x, m.scene.y});
  return py::make_tuple(d.object, d.view, d.confidence, d.probability, d.log10_false_alarms,
                        d.inliers, d.features_in_area, homography, outline, box_of(d),
                        d.alternatives, matches);
}

Detection detection_from(const py::tuple& state) {
  Detection d;
  d.object = state[0].cast<std::string>();
  d.view = state[1].cast<std::string>();
  d.confidence = state[2].cast<double>();
  d.probability = state[3].cast<double>();
  d.log10_false_alarms = state[4].cast<double>();
  d.inliers = state[5].cast<int>();
  d.features_in_area = state[6].cast<int>();
  const auto homography = state[7].cast<std::vector<double>>();
  for (std::size_t i = 0; i < 9; ++i) d.scene_from_view.val[i] = homography.at(i);
  const auto outline = state[8].cast<std::vector<float>>();
  for (std::size_t i = 0; i + 1 < outline.size(); i += 2)
    d.outline.emplace_back(outline[i], outline[i + 1]);
  const auto box = state[9].cast<std::vector<double>>();
  d.box = {box.at(0), box.at(1), box.at(2), box.at(3)};
  d.alternatives = state[10].cast<std::vector<std::string>>();
  const auto matches = state[11].cast<std::vector<float>>();
  for (std::size_t i = 0; i + 3 < matches.size(); i += 4)
    d.matches.push_back({{matches[i], matches[i + 1]}, {matches[i + 2], matches[i + 3]}});
  return d;
}

void bind_detection(py::module_& module) {
  py::class_<Detection, std::shared_ptr<Detection>>(
      module, "Detection", "One physical instance of a taught object in the scene.")
      .def_readonly("object", &Detection::object, "Name of the object.")
      .def_readonly("view", &Detection::view, "Id of the taught view that explains it best.")
      .def_readonly("confidence", &Detection::confidence,
                    "Matched features / features of the scene in the area (Eq. 11 of the paper).")
      .def_readonly("probability", &Detection::probability, "That it is no accident, 0 to 1.")
      .def_readonly("log10_false_alarms", &Detection::log10_false_alarms,
                    "log10 of the expected number of such accidents per picture.")
      .def_readonly("inliers", &Detection::inliers, "Matched features that agree on the pose.")
      .def_readonly("features_in_area", &Detection::features_in_area,
                    "Features of the scene inside the outline.")
      .def_property_readonly("homography", &homography_of,
                             "3 x 3, float64: view px -> scene px, [2, 2] = 1.")
      .def_property_readonly(
          "outline", [](const Detection& d) { return points_array(d.outline); },
          "The view's silhouette in the scene: N x 2, float32, px.")
      .def_property_readonly(
          "box", &box_of, "(x, y, width, height) of the outline, px; may reach beyond the picture.")
      .def_readonly("alternatives", &Detection::alternatives,
                    "Objects that the evidence cannot tell apart from it.")
      .def_property_readonly("matches", &matches_of,
                             "N x 2 x 2, float32: [i, 0] is a point of the view, [i, 1] the point\n"
                             "of the scene that it was matched with; px.")
      .def(
          "to_dict", [](const Detection& d) { return to_python(to_line(to_json(d))); },
          "As in the lines of 'posevote recognize --json'.")
      .def("__repr__", &detection_text)
      .def(py::pickle(&detection_state, &detection_from));
}

void bind_stages(py::module_& module) {
  py::class_<StageTimes>(module, "StageTimes", "Milliseconds of each step.")
      .def_readonly("detect", &StageTimes::detect,
                    "Finding and describing the picture's features, ms.")
      .def_readonly("match", &StageTimes::match, "Comparing them with those of all views, ms.")
      .def_readonly("vote", &StageTimes::vote,
                    "Grouping the matches by the pose that they speak for, ms.")
      .def_readonly("verify", &StageTimes::verify, "Fitting poses and judging the evidence, ms.")
      .def_readonly("total", &StageTimes::total, "All of it, ms.")
      .def("to_dict",
           [](const StageTimes& t) {
             return py::dict(py::arg("detect") = t.detect, py::arg("match") = t.match,
                             py::arg("vote") = t.vote, py::arg("verify") = t.verify,
                             py::arg("total") = t.total);
           })
      .def("__repr__", [](const StageTimes& t) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "StageTimes(detect=%.1f, match=%.1f, vote=%.1f, verify=%.1f, total=%.1f)",
                      t.detect, t.match, t.vote, t.verify, t.total);
        return std::string(text);
      });
  py::class_<StageCounts>(module, "StageCounts", "Numbers of features that survive each step.")
      .def_readonly("features", &StageCounts::features, "Of the picture.")
      .def_readonly("matched", &StageCounts::matched, "Of them, matched with a feature of a view.")
      .def_readonly("clustered", &StageCounts::clustered,
                    "Of those, in a group that agrees on a pose.")
      .def_readonly("verified", &StageCounts::verified, "Of those, evidence of a detection.")
      .def("to_dict",
           [](const StageCounts& c) {
             return py::dict(py::arg("features") = c.features, py::arg("matched") = c.matched,
                             py::arg("clustered") = c.clustered, py::arg("verified") = c.verified);
           })
      .def("__repr__", [](const StageCounts& c) {
        return "StageCounts(features=" + std::to_string(c.features) +
               ", matched=" + std::to_string(c.matched) +
               ", clustered=" + std::to_string(c.clustered) +
               ", verified=" + std::to_string(c.verified) + ")";
      });
}

std::shared_ptr<Detection> detection_at(const SharedResult& result, std::size_t i) {
  return {result, &result->detections[i]};
}

py::list detections_of(const SharedResult& result) {
  py::list list;
  for (std::size_t i = 0; i < result->detections.size(); ++i) list.append(detection_at(result, i));
  return list;
}

/// [((x, y, width, height), features), ...]
py::list unknown_of(const RecognitionResult& r) {
  py::list list;
  for (const UnknownRegion& region : r.unknown) {
    const cv::Rect2f& box = region.box;
    list.append(
        py::make_tuple(py::make_tuple(box.x, box.y, box.width, box.height), region.features));
  }
  return list;
}

py::tuple result_state(const RecognitionResult& r) {
  py::list detections;
  for (const Detection& d : r.detections) detections.append(detection_state(d));
  return py::make_tuple(
      r.image_size.width, r.image_size.height, detections,
      std::vector<double>{r.time_ms.detect, r.time_ms.match, r.time_ms.vote, r.time_ms.verify,
                          r.time_ms.total},
      std::vector<int>{r.counts.features, r.counts.matched, r.counts.clustered, r.counts.verified},
      unknown_of(r), r.incomplete);
}

SharedResult result_from(const py::tuple& state) {
  auto r = std::make_shared<RecognitionResult>();
  r->image_size = {state[0].cast<int>(), state[1].cast<int>()};
  for (const auto& d : state[2].cast<py::list>())
    r->detections.push_back(detection_from(d.cast<py::tuple>()));
  const auto t = state[3].cast<std::vector<double>>();
  r->time_ms = {t.at(0), t.at(1), t.at(2), t.at(3), t.at(4)};
  const auto c = state[4].cast<std::vector<int>>();
  r->counts = {c.at(0), c.at(1), c.at(2), c.at(3)};
  for (const auto& region : state[5].cast<py::list>()) {
    const auto [box, features] = region.cast<std::pair<std::array<float, 4>, int>>();
    r->unknown.push_back({{box[0], box[1], box[2], box[3]}, features});
  }
  r->incomplete = state[6].cast<bool>();
  return r;
}

void bind_result(py::module_& module) {
  py::class_<RecognitionResult, SharedResult>(
      module, "Recognition",
      "What was found in a picture: best first, each physical instance once.\n\n"
      "len(), iteration and indexing are over the detections.")
      .def_property_readonly(
          "width", [](const RecognitionResult& r) { return r.image_size.width; },
          "Of the picture, px.")
      .def_property_readonly(
          "height", [](const RecognitionResult& r) { return r.image_size.height; },
          "Of the picture, px.")
      .def_property_readonly("detections", &detections_of, "List of Detection, best first.")
      .def_property_readonly("unknown", &unknown_of,
                             "Textured parts that no object explains, with the option `unknown`:\n"
                             "a list of ((x, y, width, height), features), most features first.")
      .def_readonly("incomplete", &RecognitionResult::incomplete,
                    "True when the option `deadline_ms` came before all was looked at.")
      .def_readonly("time_ms", &RecognitionResult::time_ms, "StageTimes, ms.")
      .def_readonly("counts", &RecognitionResult::counts, "StageCounts.")
      .def("__len__", [](const RecognitionResult& r) { return r.detections.size(); })
      .def("__iter__", [](const SharedResult& r) { return py::iter(detections_of(r)); })
      .def("__getitem__",
           [](const SharedResult& r, const py::object& i) {
             return detections_of(r).attr("__getitem__")(i);
           })
      .def(
          "to_dict",
          [](const RecognitionResult& r, const std::string& image) {
            return to_python(to_line(to_json(r, image)));
          },
          py::arg("image") = "",
          "to_dict(image='') -> dict\n\nThe line of 'posevote recognize --json' for picture "
          "`image`.")
      .def(
          "to_json",
          [](const RecognitionResult& r, const std::string& image) {
            return to_line(to_json(r, image));
          },
          py::arg("image") = "", "to_json(image='') -> str\n\nThe same line as text.")
      .def("__repr__",
           [](const SharedResult& r) {
             return "Recognition(" + std::to_string(r->image_size.width) + " x " +
                    std::to_string(r->image_size.height) +
                    " px, detections=" + std::string(py::repr(detections_of(r))) + ")";
           })
      .def(py::pickle(&result_state, &result_from));
}

}  // namespace

void bind_results(py::module_& module) {
  bind_detection(module);
  bind_stages(module);
  bind_result(module);
}

}  // namespace posevote::python
