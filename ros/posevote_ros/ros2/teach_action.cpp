#include "ros2/teach_action.hpp"

#include "logic/fill_message.hpp"
#include "logic/teach_loop.hpp"
#include "ros2/convert.hpp"
#include "ros2/node.hpp"

namespace posevote::ros2 {
TeachAction::TeachAction(Node& node) : node_(node) {
  offer_capture();
  server_ = rclcpp_action::create_server<Teach>(
      &node, std::string(node.get_name()) + "/teach",
      [this](const rclcpp_action::GoalUUID&, std::shared_ptr<const Teach::Goal>) {
        return busy_.exchange(true) ? rclcpp_action::GoalResponse::REJECT
                                    : rclcpp_action::GoalResponse::ACCEPT_AND_EXECUTE;
      },
      [](const std::shared_ptr<Goal>&) { return rclcpp_action::CancelResponse::ACCEPT; },
      [this](const std::shared_ptr<Goal>& goal) { start(goal); });
}

TeachAction::~TeachAction() {
  stopped_ = true;
  if (thread_.joinable()) thread_.join();  // while the server can still send the goal's result
  server_.reset();
}

void TeachAction::offer_capture() {
  capture_service_ = node_.create_service<Capture>(
      "~/capture",
      [this](const std::shared_ptr<Capture::Request>, std::shared_ptr<Capture::Response> response) {
        response->success = busy_;
        if (busy_)
          capture_ = true;
        else
          response->message = "nothing is being taught; send a goal to the action teach first";
      });
}

void TeachAction::start(const std::shared_ptr<Goal>& goal) {
  if (thread_.joinable()) thread_.join();  // it has ended: it was not busy
  thread_ = std::thread([this, goal] {
    execute(goal);
    busy_ = false;
  });
}

bool TeachAction::is_cancelled(const Goal& goal) const {
  return stopped_ || goal.is_canceling() || !rclcpp::ok();
}

void TeachAction::execute(const std::shared_ptr<Goal>& goal) {
  capture_ = false;
  const auto result = std::make_shared<Teach::Result>();
  try {
    logic::fill_result(
        *result, goal->get_goal()->images.empty() ? teach_from_camera(*goal) : teach_given(*goal));
    if (goal->is_canceling()) {
      goal->canceled(result);
    } else if (is_cancelled(*goal)) {
      result->message = "the node was stopped while it taught";
      goal->abort(result);
    } else {
      goal->succeed(result);
    }
  } catch (const std::exception& error) {
    result->message = error.what();
    if (goal->is_canceling())
      goal->canceled(result);
    else
      goal->abort(result);
  }
}

logic::TeachView TeachAction::teach_view(const std::string& object, const std::string& source) {
  return [this, object, source](const ViewSource& view) {
    const logic::TaughtPicture taught = node_.recognition().teach(object, view, source);
    node_.publish_database();
    return taught;
  };
}

void TeachAction::report(Goal& goal, const logic::TeachProgress& progress,
                         const std_msgs::msg::Header& header) {
  const auto feedback = std::make_shared<Teach::Feedback>();
  logic::fill_feedback(*feedback, progress, header);
  goal.publish_feedback(feedback);
}

logic::TeachProgress TeachAction::teach_given(Goal& goal) {
  const auto asked = goal.get_goal();
  std::vector<cv::Mat> pictures;
  for (const sensor_msgs::msg::Image& image : asked->images) pictures.push_back(to_picture(image));
  cv::Mat background;
  if (asked->background.width > 0) background = to_picture(asked->background);
  return logic::teach_pictures(logic::to_lesson(*asked), pictures, background,
                               teach_view(asked->object, "pictures of the action teach"),
                               [&](const logic::TeachProgress& progress) {
                                 report(goal, progress, asked->images[0].header);
                                 return !is_cancelled(goal);
                               });
}

logic::TeachProgress TeachAction::teach_from_camera(Goal& goal) {
  const auto asked = goal.get_goal();
  const std::string topic = camera_topic(node_);
  logic::TeachSession session(logic::to_lesson(*asked), node_.recognition().options().watch,
                              teach_view(asked->object, topic));
  logic::TeachLoop<Frame> loop{
      node_.frames(),
      topic,
      asked->timeout_s,
      [](const Frame& frame) { return rclcpp::Time(frame.header.stamp).seconds(); },
      [this] { return capture_.exchange(false); },
      [&] { return is_cancelled(goal); },
      [&](const logic::TeachProgress& progress, const Frame* frame) {
        report(goal, progress, frame ? frame->header : std_msgs::msg::Header());
      }};
  return loop.run(session);
}

}  // namespace posevote::ros2
