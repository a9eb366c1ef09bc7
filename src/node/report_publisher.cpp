#include "node/report_publisher.hpp"

namespace fast_edi {

void ReportPublisher::advertise(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                                const std::string& name, const std::string& task,
                                const Filler& fill) {
  updater_.emplace(nh, private_nh, name);
  updater_->setHardwareID("none");
  updater_->add(task, fill);
}

void ReportPublisher::publish(const std::vector<Complaint>& complaints, std::int64_t now_ns) {
  for (const Complaint& complaint : complaints) {
    warnings_.warn(complaint.kind, complaint.text, now_ns);
  }
  updater_->force_update();
}

}  // namespace fast_edi
