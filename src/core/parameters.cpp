#include "fast_edi/core/parameters.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace fast_edi {
namespace {

void requireThreshold(const char* name, double value) {
  if (!std::isfinite(value) || value <= 0.0) {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                                ", expected a finite number > 0");
  }
}

void requireWithin(const char* name, std::int64_t value_ns, std::int64_t lowest_ns,
                   std::int64_t highest_ns) {
  if (value_ns < lowest_ns || value_ns > highest_ns) {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value_ns) +
                                " ns, expected " + std::to_string(lowest_ns) + ".." +
                                std::to_string(highest_ns) + " ns");
  }
}

}  // namespace

void validate(const DeblurParameters& parameters) {
  requireThreshold("contrast_threshold_on", parameters.thresholds.on);
  requireThreshold("contrast_threshold_off", parameters.thresholds.off);
  requireWithin("exposure time", parameters.exposure_time_ns, 0, kMaxExposure_ns);
  requireWithin("time offset", parameters.time_offset_ns, -kMaxTimeOffset_ns, kMaxTimeOffset_ns);
  requireWithin("close timeout", parameters.close_timeout_ns, 1, kMaxTimeLimit_ns);
  requireWithin("maximal backward jump", parameters.max_backward_jump_ns, 1, kMaxTimeLimit_ns);
  requireWithin("maximal forward jump", parameters.max_forward_jump_ns, 1, kMaxTimeLimit_ns);
  if (parameters.max_buffered_events < 1) {
    throw std::invalid_argument("max_buffered_events is 0, expected 1 or more");
  }
  validate(parameters.latent);
  validate(parameters.filter);
}

}  // namespace fast_edi
