// Receives the streams of DV inside a nodelet manager.

#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "stream_node/dv_stream_node.hpp"

namespace fast_edi {

class DvStreamNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    node_ = std::make_unique<DvStreamNode>(getNodeHandle(), getPrivateNodeHandle(), getName());
  }

  std::unique_ptr<DvStreamNode> node_;
};

}  // namespace fast_edi

PLUGINLIB_EXPORT_CLASS(fast_edi::DvStreamNodelet, nodelet::Nodelet)
