// What the node logic puts into messages fits those of ROS 2, too.
#include <cstdio>
#include <posevote_msgs/action/teach.hpp>
#include <posevote_msgs/msg/detection_array.hpp>
#include <posevote_msgs/srv/detect.hpp>
#include <posevote_msgs/srv/export_objects.hpp>
#include <posevote_msgs/srv/import_objects.hpp>
#include <posevote_msgs/srv/list_objects.hpp>
#include <posevote_msgs/srv/remove_object.hpp>
#include <posevote_msgs/srv/rename_object.hpp>
#include <posevote_msgs/srv/save_database.hpp>
#include <posevote_msgs/srv/set_active_objects.hpp>

#include "logic/serve.hpp"
#include "posevote/image/read_image.hpp"

namespace {

using namespace posevote;
using posevote_msgs::action::Teach;

int failures = 0;

void expect(bool condition, const char* what) {
  if (condition) return;
  ++failures;
  std::fprintf(stderr, "not true: %s\n", what);
}

/// Calls a service as both shells do.
template <class Service, class Act>
typename Service::Response call(logic::ObjectRecognition& recognition, const Act& act,
                                const typename Service::Request& request = {}) {
  typename Service::Response response;
  logic::serve(request, response,
               [&](const auto& asked, auto& given) { act(recognition, asked, given); });
  return response;
}

void teach(logic::ObjectRecognition& recognition, const cv::Mat& cover) {
  Teach::Goal goal;
  goal.object = "poster";
  goal.method = "whole";
  goal.images.resize(1);
  logic::fill_image(goal.images[0], cover);
  Teach::Feedback feedback;
  Teach::Result result;
  const auto progress = logic::teach_pictures(
      logic::to_lesson(goal), {logic::to_picture(logic::view_of(goal.images[0]))}, {},
      [&](const ViewSource& source) { return recognition.teach(goal.object, source, "test"); },
      [&](const logic::TeachProgress& now) {
        logic::fill_feedback(feedback, now, goal.images[0].header);
        return true;
      });
  logic::fill_result(result, progress);
  expect(result.success && result.views_added == 1, "the picture is taught");
  expect(feedback.step == "done" && feedback.preview.width > 0, "the feedback has a preview");
}

}  // namespace

int main(int, char** argv) {
  using namespace posevote_msgs::srv;
  const std::string demo = argv[1], folder = argv[2];
  logic::ObjectRecognition node({{"database", folder + "/objects.db"}});
  teach(node, read_image(demo + "/train/poster/cover.jpg"));

  Detect::Response detected;
  detected.result.header.frame_id = "camera";
  logic::detect_in(node, read_image(demo + "/test/reading.jpg"), std::nullopt,
                   detected.result.header, true, detected);
  expect(detected.result.detections.size() == 1, "one object is found");
  expect(detected.result.detections.at(0).object == "poster", "it is the poster");
  expect(detected.result.detections[0].homography[8] == 1, "it has a homography");
  expect(detected.annotated.width == 1280, "it is drawn");

  const auto list = [](auto&... of) { logic::list_objects(of...); };
  expect(call<ListObjects>(node, list).database.objects.size() == 1, "it is listed");
  SetActiveObjects::Request active;
  active.objects = {"nothing"};
  expect(!call<SetActiveObjects>(
              node, [](auto&... of) { logic::set_active_objects(of...); }, active)
              .success,
         "nothing cannot be looked for");
  ExportObjects::Request exported;
  exported.path = folder + "/exported.posevote";
  expect(call<ExportObjects>(
             node, [](auto&... of) { logic::export_objects(of...); }, exported)
                 .views_written == 1,
         "it is exported");
  SaveDatabase::Request saved;
  saved.path = folder + "/saved.db";
  expect(call<SaveDatabase>(
             node, [](auto&... of) { logic::save_database(of...); }, saved)
             .success,
         "it is saved");
  RenameObject::Request renamed;
  renamed.object = "poster";
  renamed.new_name = "print";
  expect(call<RenameObject>(
             node, [](auto&... of) { logic::rename_object(of...); }, renamed)
             .success,
         "it is renamed");
  RemoveObject::Request removed;
  removed.object = "print";
  expect(call<RemoveObject>(
             node, [](auto&... of) { logic::remove_object(of...); }, removed)
             .success,
         "it is removed");
  ImportObjects::Request imported;
  imported.path = exported.path;
  expect(call<ImportObjects>(
             node, [](auto&... of) { logic::import_objects(of...); }, imported)
                 .views_added == 1,
         "it is imported");
  return failures == 0 ? 0 : 1;
}
