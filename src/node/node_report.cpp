#include "node/node_report.hpp"

namespace fast_edi {

NodeReport::NodeReport(const std::string& name, const InputTopics& topics)
    : diagnostics_(topics), publisher_(name) {}

void NodeReport::advertise(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                           const std::string& name) {
  publisher_.advertise(nh, private_nh, name, "deblurring",
                       [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
                         diagnostics_.fill(close_latency_, output_latency_, status);
                       });
}

void NodeReport::startListening(std::int64_t now_ns) {
  snapshot_.listening_since_ns = now_ns;
  snapshot_.last_frame_ns = 0;
  snapshot_.last_events_ns = 0;
}

void NodeReport::addOutput(std::int64_t published_ns, std::int64_t completed_ns,
                           std::int64_t arrived_ns) {
  ++snapshot_.frames_out;
  close_latency_.add(published_ns - completed_ns);
  output_latency_.add(published_ns - arrived_ns);
}

void NodeReport::addInternalError(const std::string& error, std::int64_t now_ns) {
  ++snapshot_.internal_errors;
  snapshot_.internal_error = error;
  publisher_.warnings().warn("internal error", error, now_ns);
}

void NodeReport::addRefusedValue(const std::string& refusal) {
  ++snapshot_.values_refused;
  snapshot_.value_refusal = refusal;
}

void NodeReport::addRefusedBiases(const std::string& refusal) {
  if (!refusal.empty()) {
    ++snapshot_.bias_updates_refused;
    snapshot_.bias_refusal = refusal;
  }
}

void NodeReport::addRefusedCameraInfo(const std::string& refusal) {
  ++snapshot_.camera_infos_refused;
  snapshot_.camera_info_refusal = refusal;
}

void NodeReport::setPipeline(const Deblurrer& deblurrer, const std::string& contrast_origin,
                             bool listening) {
  snapshot_.listening = listening;
  snapshot_.contrast_origin = contrast_origin;
  snapshot_.counters = deblurrer.counters();
  snapshot_.status = deblurrer.status();
  snapshot_.thresholds = deblurrer.parameters().thresholds;
}

void NodeReport::publish(std::int64_t now_ns) {
  snapshot_.time_ns = now_ns;
  diagnostics_.update(snapshot_);
  publisher_.publish(diagnostics_.complaints(), now_ns);
}

}  // namespace fast_edi
