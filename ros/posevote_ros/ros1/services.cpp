#include "ros1/services.hpp"

#include <posevote_msgs/Detect.h>
#include <posevote_msgs/ExportObjects.h>
#include <posevote_msgs/ImportObjects.h>
#include <posevote_msgs/ListObjects.h>
#include <posevote_msgs/RemoveObject.h>
#include <posevote_msgs/RenameObject.h>
#include <posevote_msgs/SaveDatabase.h>
#include <posevote_msgs/SetActiveObjects.h>

#include "logic/serve.hpp"
#include "posevote/core/error.hpp"
#include "ros1/node.hpp"

namespace posevote::ros1 {
namespace {

constexpr double default_timeout_s = 5;

/// The given picture, or the camera's next.
Frame frame_for(Node& node, const posevote_msgs::Detect::Request& request) {
  if (request.image.width > 0 || !request.image.data.empty()) {
    Frame frame{request.image.header, boost::make_shared<sensor_msgs::Image>(request.image),
                nullptr, nullptr};
    if (request.camera_info.K[0] > 0)
      frame.info = boost::make_shared<sensor_msgs::CameraInfo>(request.camera_info);
    return frame;
  }
  const Node::Demand demand(node);
  std::uint64_t seen = node.frames().number();
  const double timeout_s = request.timeout_s > 0 ? request.timeout_s : default_timeout_s;
  const auto frame = node.frames().wait_newer(seen, std::chrono::duration<double>(timeout_s));
  if (!frame)
    throw Error(ErrorCode::io, "no picture came from '" + node.camera_topic() + "' in time");
  return *frame;
}

void detect(Node& node, const posevote_msgs::Detect::Request& request,
            posevote_msgs::Detect::Response& response) {
  const Frame frame = frame_for(node, request);
  logic::detect_in(node.recognition(), frame.picture(), frame.camera(), frame.header,
                   request.annotate, response);
}

}  // namespace

template <class Service, class Act>
void Services::add(ros::NodeHandle& nh, const std::string& name, Act act) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> answer = [this, act](Request& request,
                                                                        Response& response) {
    logic::serve(request, response, [&](const Request& asked, Response& given) {
      act(node_.recognition(), asked, given);
      node_.publish_database();
    });
    return true;
  };
  servers_.push_back(nh.advertiseService(name, answer));
}

Services::Services(ros::NodeHandle private_nh, Node& node) : node_(node) {
  using namespace posevote_msgs;
  const auto offer = [&](auto service, const std::string& name, auto act) {
    add<decltype(service)>(private_nh, name, act);
  };
  offer(ListObjects(), "list_objects", [](auto&... of) { logic::list_objects(of...); });
  offer(RemoveObject(), "remove_object", [](auto&... of) { logic::remove_object(of...); });
  offer(RenameObject(), "rename_object", [](auto&... of) { logic::rename_object(of...); });
  offer(SetActiveObjects(), "set_active_objects",
        [](auto&... of) { logic::set_active_objects(of...); });
  offer(SaveDatabase(), "save_database", [](auto&... of) { logic::save_database(of...); });
  offer(ExportObjects(), "export_objects", [](auto&... of) { logic::export_objects(of...); });
  offer(ImportObjects(), "import_objects", [](auto&... of) { logic::import_objects(of...); });
  offer(Detect(), "detect",
        [this](auto&, const auto& request, auto& response) { detect(node_, request, response); });
}

}  // namespace posevote::ros1
