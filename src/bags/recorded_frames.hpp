/// \file
/// The grey frames of one topic of a recording, all at once.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "fast_edi/bags/bag_index.hpp"

namespace fast_edi {

/// One channel of 8 bits: colour is turned to grey, raw Bayer is taken photosite by photosite, as
/// it is deblurred. \return an empty image for an encoding that is not deblurred
cv::Mat toMono8(const sensor_msgs::Image& message);

struct RecordedFrames {
  std::map<std::int64_t, cv::Mat> by_stamp;  ///< [ns] -> toMono8()
  std::uint64_t malformed = 0;               ///< messages that contradict themselves, left out
  std::vector<BagDamage> damage;
};

/// \throws BagError when a recording cannot be opened
RecordedFrames readFrames(const std::vector<std::string>& recordings, const std::string& topic);

/// The same for frames that must be there.
/// \throws BagError naming the recording and its topics with images when there is none on \p topic
RecordedFrames requireFrames(const std::string& recording, const std::string& topic);

}  // namespace fast_edi
