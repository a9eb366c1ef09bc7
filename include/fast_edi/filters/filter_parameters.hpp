/// \file
/// Parameters of all that goes beyond plain EDI.
#pragma once

#include "fast_edi/filters/gain_filter.hpp"

namespace fast_edi {

struct FilterParameters {
  bool enabled = true;  ///< false: plain EDI
  GainFilter::Settings gain;
  bool frame_noise = true;        ///< take out the frame's own noise, too
  double frame_noise_kept = 0.3;  ///< fraction of it that stays, see FrameNoiseFilter
  double frame_noise_dn = 0.0;    ///< its standard deviation [8-bit DN]; 0 = measured in each frame
  double temporal = 0.0;          ///< weight of the image before; 0 = off, see TemporalFusion
  bool reblur = true;             ///< recover what causes no events, see Reblur
  bool motion = true;             ///< stabilise images away from mid-exposure
};

/// \throws std::invalid_argument naming the parameter, its value and what was expected
void validate(const FilterParameters& parameters);

}  // namespace fast_edi
