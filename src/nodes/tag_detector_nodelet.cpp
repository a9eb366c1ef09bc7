// Detects AprilTags inside a nodelet manager.

#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "tag_node/tag_detector_node.hpp"

namespace fast_edi {

class TagDetectorNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    node_ = std::make_unique<TagDetectorNode>(getNodeHandle(), getPrivateNodeHandle(), getName());
  }

  std::unique_ptr<TagDetectorNode> node_;
};

}  // namespace fast_edi

PLUGINLIB_EXPORT_CLASS(fast_edi::TagDetectorNodelet, nodelet::Nodelet)
