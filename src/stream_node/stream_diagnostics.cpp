#include "stream_node/stream_diagnostics.hpp"

#include <utility>

#include "fast_edi/base/sensor_size.hpp"
#include "fast_edi/base/types.hpp"
#include "node/status_values.hpp"

namespace fast_edi {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kBytesPerMegabyte = 1e6;

std::string nameOf(const StreamReport& stream) {
  return std::string(toString(stream.kind)) + " of " + stream.server;
}

}  // namespace

void StreamDiagnostics::update(const StreamSnapshot& now) {
  before_ = std::exchange(now_, now);
  complaints_.clear();
  news_.clear();
  before_.streams.resize(now_.streams.size());
  for (std::size_t i = 0; i < now_.streams.size(); ++i) {
    compare(now_.streams[i], before_.streams[i].status);
  }
  compareFrames();
}

void StreamDiagnostics::compare(const StreamReport& now, const StreamStatus& before) {
  const StreamStatus& status = now.status;
  const std::string name = nameOf(now);
  if (status.cuts > before.cuts) {
    complaints_.push_back({"cut " + name, std::to_string(status.cuts - before.cuts) +
                                              " connection(s) for " + name +
                                              " ended: " + status.cut});
  }
  if (status.damaged > before.damaged) {
    complaints_.push_back({"damage " + name, std::to_string(status.damaged - before.damaged) +
                                                 " place(s) in " + name +
                                                 " could not be read: " + status.damage});
  }
  if (!status.connected && !status.fault.empty()) {
    complaints_.push_back({"missing " + name, "no " + name + ": " + status.fault});
  }
  if (status.connected && status.connections > before.connections) {
    std::string text = "connected: " + name;
    if (!status.stream.camera.empty()) {
      text += ", " + status.stream.camera;
    }
    if (status.stream.size.pixelCount() > 0) {
      text += ", " + sizeText(status.stream.size.width, status.stream.size.height);
    }
    news_.push_back(text);
  }
}

void StreamDiagnostics::compareFrames() {
  if (now_.frames_without_exposure > before_.frames_without_exposure) {
    complaints_.push_back(
        {"exposure",
         std::to_string(now_.frames_without_exposure - before_.frames_without_exposure) +
             " frame(s) came without the start and end of their exposure"});
  }
  if (now_.frames_without_calibration > before_.frames_without_calibration) {
    complaints_.push_back(
        {"calibration",
         std::to_string(now_.frames_without_calibration - before_.frames_without_calibration) +
             " frame(s) have another size than the calibration, and no camera_info"});
  }
}

void StreamDiagnostics::summarise(DiagnosticStatusWrapper& status) const {
  if (!now_.configuration_error.empty()) {
    status.summary(DiagnosticStatus::ERROR,
                   "idle, configuration refused: " + now_.configuration_error);
    return;
  }
  std::string received;
  for (const StreamReport& stream : now_.streams) {
    if (stream.status.connected) {
      received += (received.empty() ? "receiving " : ", ") + std::string(toString(stream.kind));
    }
  }
  status.summary(DiagnosticStatus::OK, received.empty() ? "receiving nothing" : received);
  for (const StreamReport& stream : now_.streams) {
    if (!stream.status.connected && stream.status.fault.empty()) {
      status.mergeSummary(DiagnosticStatus::WARN, "connecting: " + nameOf(stream));
    }
  }
  for (const Complaint& complaint : complaints_) {
    const bool missing = complaint.kind.rfind("missing", 0) == 0;
    status.mergeSummary(missing ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN, complaint.text);
  }
}

void StreamDiagnostics::fill(DiagnosticStatusWrapper& wrapper) const {
  summarise(wrapper);
  StatusValues values(wrapper);
  const std::int64_t elapsed_ns = before_.time_ns == 0 ? 0 : now_.time_ns - before_.time_ns;
  const double elapsed_s =
      static_cast<double>(elapsed_ns) / static_cast<double>(kNanosecondsPerSecond);
  const auto rate = [elapsed_s](std::uint64_t now, std::uint64_t before) {
    return elapsed_s > 0.0 ? static_cast<double>(now - before) / elapsed_s : 0.0;
  };
  for (std::size_t i = 0; i < now_.streams.size(); ++i) {
    const StreamReport& stream = now_.streams[i];
    const StreamStatus& status = stream.status;
    const StreamStatus before =
        i < before_.streams.size() ? before_.streams[i].status : StreamStatus{};
    const std::string kind = toString(stream.kind);
    values.add(kind + ": server", stream.server);
    values.add(kind + ": connected", status.connected       ? "yes"
                                     : status.fault.empty() ? "no: connecting"
                                                            : "no: " + status.fault);
    values.addf(kind + ": rate [1/s]", "%.1f", rate(status.items, before.items));
    values.addf(kind + ": data [MB/s]", "%.3f",
                rate(status.bytes, before.bytes) / kBytesPerMegabyte);
    values.add(kind + ": received", status.items);
    values.add(kind + ": packets", status.packets);
    values.add(kind + ": connections", status.connections);
    values.add(kind + ": cuts", status.cuts);
    values.add(kind + ": stalls", status.stalls);
    values.add(kind + ": damaged places", status.damaged);
  }
  values.add("frames without exposure", now_.frames_without_exposure);
  values.add("frames without calibration", now_.frames_without_calibration);
}

}  // namespace fast_edi
