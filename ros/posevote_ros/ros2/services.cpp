#include "ros2/services.hpp"

#include <posevote_msgs/srv/export_objects.hpp>
#include <posevote_msgs/srv/import_objects.hpp>
#include <posevote_msgs/srv/list_objects.hpp>
#include <posevote_msgs/srv/remove_object.hpp>
#include <posevote_msgs/srv/rename_object.hpp>
#include <posevote_msgs/srv/save_database.hpp>
#include <posevote_msgs/srv/set_active_objects.hpp>

#include "logic/serve.hpp"
#include "posevote/core/error.hpp"
#include "ros2/node.hpp"

namespace posevote::ros2 {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double default_timeout_s = 5;

}  // namespace

template <class Service, class Act>
void Services::offer(const std::string& name, Act act) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  servers_.push_back(node_.create_service<Service>(
      "~/" + name,
      [this, act](const std::shared_ptr<Request> request, std::shared_ptr<Response> response) {
        logic::serve(*request, *response, [&](const Request& asked, Response& given) {
          act(node_.recognition(), asked, given);
          node_.publish_database();
        });
      }));
}

Services::Services(Node& node) : node_(node) {
  using namespace posevote_msgs::srv;
  offer<ListObjects>("list_objects", [](auto&... of) { logic::list_objects(of...); });
  offer<RemoveObject>("remove_object", [](auto&... of) { logic::remove_object(of...); });
  offer<RenameObject>("rename_object", [](auto&... of) { logic::rename_object(of...); });
  offer<SetActiveObjects>("set_active_objects",
                          [](auto&... of) { logic::set_active_objects(of...); });
  offer<SaveDatabase>("save_database", [](auto&... of) { logic::save_database(of...); });
  offer<ExportObjects>("export_objects", [](auto&... of) { logic::export_objects(of...); });
  offer<ImportObjects>("import_objects", [](auto&... of) { logic::import_objects(of...); });
  offer_detect();
}

Services::~Services() {
  stopped_ = true;
  servers_.clear();
  waiting_.clear();  // a future of std::async waits for its thread
}

/// Answers later: a callback that waits for the camera would keep the camera's from running.
void Services::offer_detect() {
  using Handle = std::shared_ptr<rclcpp::Service<Detect>>;
  servers_.push_back(node_.create_service<Detect>(
      "~/detect", [this](const Handle service, const std::shared_ptr<rmw_request_id_t> id,
                         const std::shared_ptr<Detect::Request> request) {
        waiting_.remove_if([](const std::future<void>& call) {
          return call.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
        });
        waiting_.push_back(std::async(std::launch::async, [this, service, id, request] {
          Detect::Response response;
          logic::serve(*request, response,
                       [this](const auto& asked, auto& given) { detect(asked, given); });
          service->send_response(*id, response);
        }));
      }));
}

void Services::detect(const Detect::Request& request, Detect::Response& response) {
  Frame frame;
  if (request.image.width > 0 || !request.image.data.empty()) {
    frame.header = request.image.header;
    frame.raw = std::make_shared<sensor_msgs::msg::Image>(request.image);
    if (request.camera_info.k[0] > 0)
      frame.info = std::make_shared<sensor_msgs::msg::CameraInfo>(request.camera_info);
  } else {
    const double timeout_s = request.timeout_s > 0 ? request.timeout_s : default_timeout_s;
    const auto end = Clock::now() + std::chrono::duration<double>(timeout_s);
    std::uint64_t seen = node_.frames().number();
    std::optional<Frame> next;
    while (!next && !stopped_ && Clock::now() < end)
      next = node_.frames().wait_newer(seen, std::chrono::milliseconds(100));
    if (!next)
      throw Error(ErrorCode::io, "no picture came from '" + camera_topic(node_) +
                                     "' in time; is the node active?");
    frame = *next;
  }
  logic::detect_in(node_.recognition(), frame.picture(), frame.camera(), frame.header,
                   request.annotate, response);
}

}  // namespace posevote::ros2
