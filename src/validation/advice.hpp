/// \file
/// What to do about a finding, in the words of what made the recording.
#pragma once

#include <string>

#include "survey/finding.hpp"

namespace fast_edi {

/// Something to be set or done where a recording is made.
enum class Remedy {
  kBackgroundActivityFilterOff,
  kRefractoryFilterOff,
  kSkipFilterOff,
  kBothPolarities,
  kHotPixelsMasked,
  kFixedFrameRegion,
  kWholeSensor,
  kFrameEncoding,
  kFewerLosses,
  kLaterStart,
  kGivenExposure,
  kHeldExposure,
  kEventsBetween,
  kBiases,  ///< "... check": which of them follows
};

/// Without a stop at its end. davis_ros_driver's and rosbag's names are named for their recordings
/// alone.
std::string adviceFor(Remedy remedy, RecordingOrigin origin);

}  // namespace fast_edi
