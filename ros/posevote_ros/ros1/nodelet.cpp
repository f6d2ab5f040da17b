#include <nodelet/nodelet.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "ros1/node.hpp"

namespace posevote::ros1 {

/// The node in a nodelet manager, where pictures are handed over without being copied.
class Nodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    node_ = std::make_unique<Node>(getMTNodeHandle(), getMTPrivateNodeHandle());
  }

  std::unique_ptr<Node> node_;
};

}  // namespace posevote::ros1

PLUGINLIB_EXPORT_CLASS(posevote::ros1::Nodelet, nodelet::Nodelet)
