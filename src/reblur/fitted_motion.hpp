/// \file
/// The motion of the image during an exposure, as MotionFit finds it.
#pragma once

#include "reblur/image_motion.hpp"

namespace fast_edi {

struct FittedMotion {
  ImageMotion motion;
  float event_share = 1.0F;   ///< part of the changes that events tell, at most 1
  float deviation_px = 0.0F;  ///< standard deviation of a displacement, largest in the image
  float path_px = 0.0F;       ///< way from start to middle and on to the end, mean over the image
  float reach_px = 0.0F;      ///< largest displacement
  bool found = false;         ///< false: too few pixels had events, the rest is 0
};

}  // namespace fast_edi
