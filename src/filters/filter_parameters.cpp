#include "fast_edi/filters/filter_parameters.hpp"

#include "fast_edi/base/parameter_ranges.hpp"

namespace fast_edi {

void validate(const FilterParameters& parameters) {
  requireWithin(limits::kFilterGainNoise, parameters.gain.noise);
  requireWithin(limits::kFilterGainSigma, parameters.gain.spatial_sigma_px);
  requireWithin(limits::kFilterGainRestore, parameters.gain.restore);
  requireWithin(limits::kFilterFrameNoiseKept, parameters.frame_noise_kept);
  requireWithin(limits::kFrameNoise, parameters.frame_noise_dn);
  requireWithin(limits::kFilterTemporal, parameters.temporal);
}

}  // namespace fast_edi
