#include "pipeline/parameter_refinement.hpp"

#include <algorithm>

namespace fast_edi {
namespace {

/// Whether what was learned from the recording under \p a is what would be learned under \p b.
bool giveTheSameCalibration(const DeblurParameters& a, const DeblurParameters& b) {
  return a.thresholds == b.thresholds && a.weighting == b.weighting && a.response == b.response &&
         a.time_offset_ns == b.time_offset_ns && a.event_delay_ns == b.event_delay_ns &&
         a.event_mapping == b.event_mapping && a.stamp_reference == b.stamp_reference &&
         a.exposure_source == b.exposure_source && a.exposure_time_ns == b.exposure_time_ns &&
         a.filter.enabled == b.filter.enabled && a.level == b.level &&
         a.refine_contrast == b.refine_contrast && a.refine_delay == b.refine_delay;
}

}  // namespace

void ParameterRefinement::setParameters(const DeblurParameters& parameters) {
  if (!giveTheSameCalibration(parameters, requested_)) {
    calibration_.reset();
  }
  requested_ = parameters;
  in_force_ = parameters;
  apply(calibration_ ? calibration_->inForce() : given());
}

void ParameterRefinement::reset() {
  calibration_.reset();
  apply(given());
}

bool ParameterRefinement::wantsFrame() const {
  return in_force_.filter.enabled && (in_force_.refine_contrast || in_force_.refine_delay) &&
         (!calibration_ || calibration_->wantsNextFrame());
}

void ParameterRefinement::learn(const ImageView& blurry, const ExposureInterval& window,
                                std::int64_t reference_ns, const EventStream& events,
                                DeblurCounters& counters) {
  if (!calibration_) {
    OnlineCalibration::Settings settings;
    settings.contrast = in_force_.refine_contrast;
    settings.delay = in_force_.refine_delay;
    settings.level = levelModel(in_force_);
    calibration_.emplace(events.lists()->size(), given(), settings);
  }
  if (!events.covers({std::min(window.start_ns, calibration_->neededFrom()), window.end_ns})) {
    calibration_->interrupt();
  }
  const CalibrationOutcome outcome = calibration_->addFrame(
      {window, reference_ns, blurry, gains_.data()}, in_force_.response, *events.lists());
  counters.calibration_fits += outcome == CalibrationOutcome::kFitted ? 1 : 0;
  counters.calibration_holes += outcome == CalibrationOutcome::kNoEventsBetween ? 1 : 0;
  counters.calibration_contradictions += outcome == CalibrationOutcome::kContradiction ? 1 : 0;
  apply(calibration_->inForce());
}

void ParameterRefinement::skipFrame() {
  if (calibration_) {
    calibration_->skipFrame();
  }
}

void ParameterRefinement::interrupt() {
  if (calibration_) {
    calibration_->interrupt();
  }
}

std::int64_t ParameterRefinement::neededFrom(std::int64_t t_ns) const {
  return calibration_ ? std::min(t_ns, calibration_->neededFrom()) : t_ns;
}

std::size_t ParameterRefinement::memoryBytes() const {
  return gains_.capacity() * sizeof(float) + (calibration_ ? calibration_->memoryBytes() : 0);
}

void ParameterRefinement::apply(const Calibration& calibration) {
  in_force_.thresholds = calibration.thresholds;
  in_force_.time_offset_ns = requested_.time_offset_ns + calibration.event_delay_ns;
}

}  // namespace fast_edi
