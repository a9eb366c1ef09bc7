/// \file
/// All frames of a recording without their pixels, each with the exposure message that belongs to
/// it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/base/image.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/sequence_gaps.hpp"
#include "fast_edi/exposure/exposure_pairing.hpp"

namespace fast_edi {

/// A frame as it was recorded.
struct FrameMessage {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;
  std::int64_t record_ns = 0;
  SensorSize size;
  ImageView pixels;   ///< empty when it cannot be deblurred, ...
  std::string fault;  ///< ... for this reason
};

struct LoggedFrame {
  std::int64_t stamp_ns = 0;
  std::int64_t record_ns = 0;
  SensorSize size;
  bool supported = false;
  std::size_t epoch = 0;                ///< of the event clock when it came
  std::int64_t length_ns = 0;           ///< of its exposure by its own message, 0 = none
  std::int64_t previous_length_ns = 0;  ///< by the message of the frame before
};

class FrameLog {
 public:
  FrameLog();

  void addFrame(const FrameMessage& frame, std::size_t epoch);
  void addExposure(std::int32_t exposure_us, std::int64_t record_ns);
  /// No message will come any more.
  void finish();
  void changeStamps(const std::function<std::int64_t(std::int64_t stamp_ns)>& change);

  const std::vector<LoggedFrame>& frames() const { return frames_; }
  const DeblurCounters& counters() const { return counters_; }  ///< exposures_...
  const std::vector<std::int32_t>& exposuresUs() const { return exposures_us_; }
  std::uint64_t gaps() const { return gaps_; }  ///< in header.seq
  std::uint64_t repeatedStamps() const { return repeated_stamps_; }
  std::uint64_t earlierStamps() const { return earlier_stamps_; }
  const std::map<std::string, std::uint64_t>& faults() const { return faults_; }
  /// Median time from frame to frame, 0 with fewer than two frames [ns].
  std::int64_t periodNs() const;

 private:
  void apply(const std::vector<ExposureMatch>& matches);

  DeblurCounters counters_;
  ExposurePairing pairing_;
  SequenceGaps sequence_gaps_;
  std::vector<LoggedFrame> frames_;
  std::vector<std::int32_t> exposures_us_;
  std::map<std::string, std::uint64_t> faults_;
  std::uint64_t gaps_ = 0;
  std::uint64_t repeated_stamps_ = 0;
  std::uint64_t earlier_stamps_ = 0;
  std::int64_t now_ns_ = 0;
};

}  // namespace fast_edi
