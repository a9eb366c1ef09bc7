#include "fast_edi/bags/bag_deblurrer.hpp"

#include <chrono>
#include <cstddef>
#include <iomanip>
#include <ostream>
#include <string>
#include <utility>

#include "bags/deblur_steps.hpp"
#include "calibration/learned_contrast.hpp"
#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

void printCount(std::ostream& out, std::uint64_t count, const std::string& what) {
  if (count > 0) {
    out << "  " << std::setw(10) << count << "  " << what << "\n";
  }
}

void printLearned(std::ostream& out, const BagDeblurReport& report) {
  constexpr int kThresholdDecimals = 3;
  constexpr int kDelayDecimals = 2;
  const double delay_ms =
      static_cast<double>(report.event_delay_ns) / static_cast<double>(kNanosecondsPerMillisecond);
  out << "in force at the end (learned from " << report.counters.calibration_fits
      << " pairs of frames)\n";
  const auto print = [&out](const std::string& value, const char* what) {
    out << "  " << std::setw(10) << value << "  " << what << "\n";
  };
  print(fixedText(report.thresholds.on, kThresholdDecimals), "contrast_threshold_on");
  print(fixedText(report.thresholds.off, kThresholdDecimals), "contrast_threshold_off");
  print(fixedText(delay_ms, kDelayDecimals), "ms by which events lag behind the light");
  const std::string remark = learnedContrastRemark(report.given_thresholds, report.thresholds,
                                                   report.counters.calibration_fits);
  if (!remark.empty()) {
    out << remark << "\n";
  }
}

}  // namespace

double BagDeblurReport::eventsPerMicrosecond() const {
  constexpr double kMicrosecondsPerSecond = 1e6;
  return seconds > 0.0 ? static_cast<double>(counters.events_in) / seconds / kMicrosecondsPerSecond
                       : 0.0;
}

void printSummary(std::ostream& out, const BagDeblurReport& report) {
  const DeblurCounters& counters = report.counters;
  out << "frames\n";
  out << "  " << std::setw(10) << counters.frames_in << "  in\n";
  out << "  " << std::setw(10) << report.outputs << "  out\n";
  out << "  " << std::setw(10) << counters.frames_deblurred << "  deblurred\n";
  printCount(out, counters.frames_still, "of these without any event (a still scene)");
  out << "  " << std::setw(10) << counters.framesPassed() << "  passed through unchanged\n";
  for (std::size_t reason = 0; reason < kPassReasonCount; ++reason) {
    printCount(out, counters.frames_passed[reason],
               std::string("of these: ") + toString(static_cast<PassReason>(reason)));
  }
  if (counters.frames_passed[static_cast<std::size_t>(PassReason::kClocksDiffer)] > 0) {
    out << "              (" << toString(report.differing_clocks)
        << "; validate_bag\n              proposes a time_offset_us)\n";
  }
  printCount(out, counters.latent_images, "latent images beside them");
  printCount(out, counters.frames_suppressed,
             "without output: stamp not later than the one before");
  printCount(out, counters.frames_timed_out, "closed by the timeout");
  printCount(out, counters.frame_time_jumps, "jumps of the frames' time");
  out << "events\n";
  out << "  " << std::setw(10) << counters.events_in << "  in " << counters.event_arrays
      << " arrays\n";
  printCount(out, counters.event_arrays_repeated, "arrays that came before: dropped");
  printCount(out, counters.event_array_gaps, "holes in the arrays' sequence numbers");
  printCount(out, counters.event_restarts, "restarts of the arrays' publisher");
  printCount(out, counters.events_late, "dropped: older than those before");
  printCount(out, counters.events_outside, "dropped: not on the sensor");
  printCount(out, counters.events_glitched, "dropped: an unconfirmed jump of time");
  printCount(out, counters.events_refused, "refused: in arrays of no usable sensor size");
  printCount(out, counters.events_overflowed, "dropped: max_buffered_events reached");
  printCount(out, counters.event_time_jumps, "jumps of the events' time");
  printCount(out, counters.size_changes, "changes of the sensor's size");
  out << "exposures\n";
  out << "  " << std::setw(10) << counters.exposures_in << "  in\n";
  printCount(out, counters.exposures_refused, "refused: not within 0 to 1 s");
  printCount(out, counters.exposures_surplus, "surplus");
  printCount(out, counters.exposures_missing, "missing");
  if (counters.calibration_fits > 0) {
    printLearned(out, report);
  }
  out << "messages\n";
  out << "  " << std::setw(10) << report.messages << "  copied\n";
  printCount(out, report.malformed_messages, "malformed: copied, not used");
  const std::ios_base::fmtflags flags = out.flags();
  const std::streamsize precision = out.precision();
  out << std::fixed << std::setprecision(2) << report.seconds << " s, " << std::setprecision(1)
      << report.eventsPerMicrosecond() << " Mev/s\n";
  out.flags(flags);
  out.precision(precision);
}

BagDeblurrer::BagDeblurrer(MessageSource& reader, BagWriter* writer, const TopicNames& topics,
                           const LoadedParameters& parameters, Progress progress)
    : reader_(reader),
      writer_(writer),
      image_topic_(topics.outputImage()),
      camera_info_topic_(topics.outputCameraInfo()),
      latent_topic_(topics.outputLatent()),
      write_latent_(parameters.deblur.latent.rate_hz == 0),
      filter_(parameters.deblur.filter),
      progress_(std::move(progress)),
      pipeline_(topics, parameters) {
  report_.given_thresholds = parameters.deblur.thresholds;
}

void BagDeblurrer::setThreads(std::size_t threads) {
  threads_ = threads;
  if (threads_ > 1) {
    pipeline_.deferWork();
  }
}

BagDeblurReport BagDeblurrer::run() {
  const auto start = std::chrono::steady_clock::now();
  DeblurSteps steps;
  steps.stops = [this] { return report_.interrupted = stop_requested_ && stop_requested_(); };
  steps.read = [this](ReadMessage& read_message) {
    const bool more = reader_.next(read_message.message);
    read_message.position = reader_.position();
    read_message.length = reader_.length();
    return more;
  };
  steps.copy = [this](const ReadMessage& read_message) {
    copy(read_message.message);
    progress_(read_message.position, read_message.length);
  };
  steps.integrate = [this](const BagMessage& message) { return integrate(message); };
  steps.finish = [this] { return finish(); };
  steps.write = [this](const BagPipeline::Output& output, const ros::Time& record_time) {
    write(output, record_time);
  };
  steps.filter = filter_;
  if (threads_ > 1) {
    deblurOnThreads(steps, threads_);
  } else {
    deblurStepByStep(steps);
  }
  report_.counters = pipeline_.counters();
  const DeblurStatus status = pipeline_.status();
  report_.differing_clocks = status.differing_clocks;
  report_.thresholds = status.thresholds;
  report_.event_delay_ns = status.event_delay_ns;
  report_.learned_pairs = status.learned_pairs;
  report_.damage = reader_.damage();
  report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report_;
}

// Members of the report: each is touched by one step alone.

void BagDeblurrer::copy(const BagMessage& message) {
  if (!message.decoded) {
    if (writer_ != nullptr) {
      writer_->copy(message);
    }
    ++report_.messages;
  }
}

std::vector<BagPipeline::Output> BagDeblurrer::integrate(const BagMessage& message) {
  report_.last_record_time = message.time;
  if (!pipeline_.add(message)) {
    ++report_.malformed_messages;
  }
  return pipeline_.takeOutputs();
}

std::vector<BagPipeline::Output> BagDeblurrer::finish() {
  pipeline_.finish();
  return pipeline_.takeOutputs();
}

void BagDeblurrer::write(const BagPipeline::Output& output, const ros::Time& record_time) {
  if (writer_ != nullptr) {
    writer_->write(image_topic_, record_time, *output.image);
    writer_->write(camera_info_topic_, record_time, *output.info);
    for (const sensor_msgs::ImagePtr& latent : output.latent) {
      if (write_latent_) {
        writer_->write(latent_topic_, record_time, *latent);
      }
    }
  }
  if (output_handler_) {
    output_handler_(output);
  }
  ++report_.outputs;
}

}  // namespace fast_edi
