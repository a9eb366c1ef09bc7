#include "tag_node/tag_report.hpp"

namespace fast_edi {

TagReport::TagReport(const std::string& name, const std::string& image_topic)
    : diagnostics_(image_topic), publisher_(name) {}

void TagReport::advertise(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                          const std::string& name) {
  publisher_.advertise(nh, private_nh, name, "tag detection",
                       [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
                         diagnostics_.fill(detection_time_, status);
                       });
}

void TagReport::startListening(std::int64_t now_ns) {
  snapshot_.listening_since_ns = now_ns;
  snapshot_.last_frame_ns = 0;
  image_gaps_.restart();
}

void TagReport::addArrival(std::uint32_t sequence, std::int64_t now_ns) {
  snapshot_.last_frame_ns = now_ns;
  snapshot_.frame_gaps += image_gaps_.step(sequence) == SequenceStep::kGap ? 1 : 0;
}

bool TagReport::repeats(const boost::shared_ptr<const void>& image) {
  const bool repeats = repeated_images_.repeats(image);
  snapshot_.frames_repeated += repeats ? 1 : 0;
  return repeats;
}

void TagReport::addRefusedImage(const std::string& refusal) {
  ++snapshot_.frames_refused;
  snapshot_.refusal = refusal;
}

void TagReport::addFrame(std::size_t tags) {
  ++snapshot_.frames;
  snapshot_.frames_with_tags += tags == 0 ? 0 : 1;
  snapshot_.tags += tags;
  snapshot_.tags_in_last_frame = tags;
}

void TagReport::addInternalError(const std::string& error, std::int64_t now_ns) {
  ++snapshot_.internal_errors;
  snapshot_.internal_error = error;
  publisher_.warnings().warn("internal error", error, now_ns);
}

void TagReport::publish(bool listening, std::int64_t now_ns) {
  snapshot_.time_ns = now_ns;
  snapshot_.listening = listening;
  diagnostics_.update(snapshot_);
  publisher_.publish(diagnostics_.complaints(), now_ns);
}

}  // namespace fast_edi
