#include "ros1/teach_action.hpp"

#include "logic/fill_message.hpp"
#include "logic/teach_loop.hpp"
#include "ros1/convert.hpp"
#include "ros1/node.hpp"

namespace posevote::ros1 {
namespace {

ros::NodeHandle with_queue(ros::NodeHandle nh, ros::CallbackQueue& queue) {
  nh.setCallbackQueue(&queue);
  return nh;
}

}  // namespace

TeachAction::TeachAction(ros::NodeHandle private_nh, Node& node)
    : node_(node),
      server_(
          with_queue(private_nh, queue_), "teach",
          [this](const posevote_msgs::TeachGoalConstPtr& goal) { execute(goal); }, false) {
  using Capture = posevote_msgs::Capture;
  const boost::function<bool(Capture::Request&, Capture::Response&)> capture =
      [this](Capture::Request&, Capture::Response& response) {
        response.success = server_.isActive();
        if (response.success)
          capture_ = true;
        else
          response.message = "nothing is being taught; send a goal to the action teach first";
        return true;
      };
  capture_service_ = private_nh.advertiseService("capture", capture);
  server_.start();
  spinner_.start();
}

TeachAction::~TeachAction() {
  stopped_ = true;  // a nodelet may be unloaded while it teaches
  spinner_.stop();
  server_.shutdown();
}

logic::TeachView TeachAction::teach_view(const std::string& object, const std::string& source) {
  return [this, object, source](const ViewSource& view) {
    const logic::TaughtPicture taught = node_.recognition().teach(object, view, source);
    node_.publish_database();
    return taught;
  };
}

void TeachAction::report(const logic::TeachProgress& progress, const std_msgs::Header& header) {
  posevote_msgs::TeachFeedback feedback;
  logic::fill_feedback(feedback, progress, header);
  server_.publishFeedback(feedback);
}

void TeachAction::execute(const posevote_msgs::TeachGoalConstPtr& goal) {
  capture_ = false;
  posevote_msgs::TeachResult result;
  try {
    logic::fill_result(result,
                       goal->images.empty() ? teach_from_camera(*goal) : teach_given(*goal));
    if (is_cancelled())
      server_.setPreempted(result, "cancelled; what was taught by then is kept");
    else
      server_.setSucceeded(result);
  } catch (const std::exception& error) {
    result.message = error.what();
    server_.setAborted(result, error.what());
  }
}

logic::TeachProgress TeachAction::teach_given(const posevote_msgs::TeachGoal& goal) {
  std::vector<cv::Mat> pictures;
  for (const sensor_msgs::Image& image : goal.images) pictures.push_back(to_picture(image));
  cv::Mat background;
  if (goal.background.width > 0) background = to_picture(goal.background);
  return logic::teach_pictures(logic::to_lesson(goal), pictures, background,
                               teach_view(goal.object, "pictures of the action teach"),
                               [&](const logic::TeachProgress& progress) {
                                 report(progress, goal.images[0].header);
                                 return !is_cancelled();
                               });
}

logic::TeachProgress TeachAction::teach_from_camera(const posevote_msgs::TeachGoal& goal) {
  logic::TeachSession session(logic::to_lesson(goal), node_.recognition().options().watch,
                              teach_view(goal.object, node_.camera_topic()));
  const Node::Demand demand(node_);
  logic::TeachLoop<Frame> loop{node_.frames(),
                               node_.camera_topic(),
                               goal.timeout_s,
                               [](const Frame& frame) { return frame.header.stamp.toSec(); },
                               [this] { return capture_.exchange(false); },
                               [this] { return is_cancelled(); },
                               [this](const logic::TeachProgress& progress, const Frame* frame) {
                                 report(progress, frame ? frame->header : std_msgs::Header());
                               }};
  return loop.run(session);
}

}  // namespace posevote::ros1
