// How well the turn of solid things is known: teaches datasets whose views and tests say how the
// objects are turned, and compares the turn of right detections with the truth. Three answers: that
// of the view itself, of the pose that takes it for a plane, of the pose with the view's relief.
// Usage: bench_poses [--focal PICTURE_WIDTHS] DATASET...
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "logic/pose.hpp"
#include "posevote/core/error.hpp"
#include "posevote/evaluate/evaluator.hpp"

namespace {

using namespace posevote;

struct Turns {
  std::vector<double> view, plane, relief;  ///< errors, degrees
};

double error_deg(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

/// The turn about the upright axis, 0: the front looks where the camera looks from.
double turn_of(const cv::Matx33d& rotation) {
  const cv::Vec3d up = rotation * cv::Vec3d(0, -1, 0), front = rotation * cv::Vec3d(0, 0, -1);
  const cv::Vec3d right = cv::normalize(cv::Vec3d(1, 0, 0) - up * up[0]);
  return std::atan2(front.dot(right), front.dot(right.cross(up))) * 180 / CV_PI;
}

/// An object and its view with that id, which in a taught dataset is unique.
std::pair<const ObjectModel*, const View*> find_view(const ModelSet& models, const Detection& of) {
  for (const ObjectModel& object : models.objects())
    if (object.name == of.object)
      for (const auto& view : object.views)
        if (view->id == of.view) return {&object, view.get()};
  return {nullptr, nullptr};
}

Turns measure(const std::string& folder, double focal_widths) {
  const Dataset dataset = load_dataset(folder);
  const RecognizeOptions options;
  TeachOptions teach;
  teach.feature = options.feature;
  const TaughtDataset taught = teach_dataset(dataset, teach);
  const Recognizer recognizer(taught.models, options);
  const auto outcomes =
      run_tests(dataset, [&](const cv::Mat& image) { return recognizer.recognize(image); });
  Turns turns;
  for (const TestOutcome& outcome : outcomes)
    for (std::size_t i = 0; i < outcome.score.judgements.size(); ++i) {
      const Judgement& judgement = outcome.score.judgements[i];
      if (judgement.verdict != Verdict::right) continue;
      const double truth =
          dataset.tests[outcome.test].objects[static_cast<std::size_t>(judgement.truth)].yaw_deg;
      const Detection& detection = outcome.result.detections[i];
      const auto [object, view] = find_view(*taught.models, detection);
      if (!view || !std::isfinite(truth) || !std::isfinite(view->yaw_deg)) continue;
      logic::Camera camera;
      camera.size = outcome.result.image_size;
      const double focal_px = focal_widths * camera.size.width;
      camera.matrix = {focal_px, 0,        (camera.size.width - 1) / 2.0,
                       0,        focal_px, (camera.size.height - 1) / 2.0,
                       0,        0,        1};
      const auto relief = logic::find_relief(*view, object->views);
      const auto solid = logic::find_pose(detection, *view, 0.2, camera, relief);
      const auto flat = logic::find_pose(detection, *view, 0.2, camera);
      if (!solid || !flat || !relief.known) continue;
      turns.view.push_back(error_deg(view->yaw_deg, truth));
      turns.plane.push_back(error_deg(turn_of(flat->pose.rotation), truth));
      turns.relief.push_back(error_deg(turn_of(solid->pose.rotation), truth));
    }
  return turns;
}

void print(const char* what, std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  const auto part = [&](double share) {
    return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  std::printf("  %-22s median %5.1f   80 %% below %5.1f   90 %% below %5.1f degrees\n", what,
              part(0.5), part(0.8), part(0.9));
}

}  // namespace

int main(int argc, char** argv) try {
  double focal_widths = 1;
  std::vector<std::string> folders;
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) == "--focal" && i + 1 < argc)
      focal_widths = std::atof(argv[++i]);
    else
      folders.emplace_back(argv[i]);
  if (folders.empty() || !(focal_widths > 0)) {
    std::fprintf(stderr, "usage: bench_poses [--focal PICTURE_WIDTHS] DATASET...\n");
    return 2;
  }
  for (const std::string& folder : folders) {
    const Turns turns = measure(folder, focal_widths);
    std::printf("%s: %zu detections of things that were taught from around\n", folder.c_str(),
                turns.view.size());
    if (turns.view.empty()) continue;
    print("the view's own turn", turns.view);
    print("taken for a plane", turns.plane);
    print("with its relief", turns.relief);
  }
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "bench_poses: %s\n", error.what());
  return 1;
}
