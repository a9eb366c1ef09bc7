// Deblurs frames inside a nodelet manager.

#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "node/deblur_node.hpp"

namespace fast_edi {

class DeblurNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    // The single-threaded queue: DeblurNode needs its callbacks in the order of arrival. A
    // configuration that is refused leaves the node idle, and the manager alive.
    node_ = std::make_unique<DeblurNode>(getNodeHandle(), getPrivateNodeHandle(), getName());
  }

  std::unique_ptr<DeblurNode> node_;
};

}  // namespace fast_edi

PLUGINLIB_EXPORT_CLASS(fast_edi::DeblurNodelet, nodelet::Nodelet)
