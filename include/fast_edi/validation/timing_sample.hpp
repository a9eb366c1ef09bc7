/// \file
/// Two consecutive frames with all events around them: what the estimate of stamps, offset and
/// exposure works on.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fast_edi/core/event_wire.hpp"
#include "fast_edi/core/image.hpp"
#include "fast_edi/core/pixel_event_lists.hpp"
#include "fast_edi/core/types.hpp"

namespace fast_edi {

struct SampledFrame {
  std::int64_t stamp_ns = 0;
  std::int64_t length_ns = 0;           ///< of its exposure by its own message, 0 = not known
  std::int64_t previous_length_ns = 0;  ///< by the message of the frame before, 0 = not known
  std::vector<float> log_exposure;      ///< row-major [natural log]; NaN: black or saturated
};

struct TimingSample {
  SampledFrame first;
  SampledFrame second;
  std::unique_ptr<PixelEventLists> events;
  std::vector<std::uint8_t> telling;  ///< row-major, 0: the pixel tells nothing; empty: all may
};

/// Which pair of frames a sample is to hold, and which events, in event time.
struct SampleRequest {
  std::size_t first_frame = 0;  ///< counted among all frames of the recording
  ExposureInterval events;
};

/// Picks the samples out of a recording that is read once more. Of large sensors every n-th row is
/// taken: some ten thousand pixels say enough, and the estimate reads them hundreds of times.
class TimingSampler {
 public:
  /// \param requests in the order of their frames
  TimingSampler(SensorSize size, const std::vector<SampleRequest>& requests);

  void addEvents(const WireEvents& events, SensorSize size);
  /// \param frame with its stamp and lengths; the pixels are read here if they are needed
  /// \param index counted among all frames
  void addFrame(std::size_t index, const SampledFrame& frame, const ImageView& image);

  /// Those that are complete. Empties the sampler.
  std::vector<TimingSample> take();
  /// Of the samples: the sensor's width and the number of rows taken.
  SensorSize sampleSize() const { return sample_size_; }

 private:
  struct Slot {
    SampleRequest request;
    TimingSample sample;
    bool has_first = false;
    bool has_second = false;
  };

  std::vector<float> logExposure(const ImageView& image) const;

  SensorSize size_;
  int row_step_;
  SensorSize sample_size_;
  std::vector<Slot> slots_;
};

}  // namespace fast_edi
