/// \file
/// Frames of a recording, found by their stamps.
#pragma once

#include <cstdint>
#include <map>

#include <opencv2/core.hpp>

namespace fast_edi {

using FramesByStamp = std::map<std::int64_t, cv::Mat>;  ///< [ns] -> CV_8UC1

/// The frame within 1 us of \p stamp_ns: a driver's stamp is mid-exposure rounded down to 1 us.
/// \return frames.end() when there is none
FramesByStamp::const_iterator frameAt(const FramesByStamp& frames, std::int64_t stamp_ns);

}  // namespace fast_edi
