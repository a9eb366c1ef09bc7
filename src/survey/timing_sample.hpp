/// \file
/// Two consecutive frames with all events around them: what the estimate of stamps, offset and
/// exposure works on.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_mapping.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {

struct SampledFrame {
  std::int64_t stamp_ns = 0;
  std::int64_t length_ns = 0;           ///< of its exposure by its own message, 0 = not known
  std::int64_t previous_length_ns = 0;  ///< by the message of the frame before, 0 = not known
  /// Of the sample's pixels, row-major [natural log]; NaN: black, saturated or not in the frame.
  std::vector<float> log_exposure;
  std::vector<std::uint8_t> levels;  ///< the whole frame, row-major [8-bit DN]
  SensorSize size;
};

struct TimingSample {
  SampledFrame first;
  SampledFrame second;
  std::unique_ptr<PixelEventLists> events;  ///< with intervals, see keepIntervals()
  std::vector<std::uint8_t> informative;    ///< row-major, 0: the pixel is not; empty: all may be
};

/// Which pair of frames a sample is to hold, and which events, in event time.
struct SampleRequest {
  std::size_t first_frame = 0;  ///< counted among all frames of the recording
  ExposureInterval events;
};

/// Which of the event sensor's pixels the samples have: every row_step-th row.
struct SampleGrid {
  SensorSize sensor;
  int row_step = 1;

  /// Of the samples: the sensor's width and the number of rows taken.
  SensorSize size() const { return {sensor.width, (sensor.height + row_step - 1) / row_step}; }
};

/// Fills in log_exposure: what the frame shows where the events of each of the sample's pixels
/// belong when they are turned as \p orientation says.
void readExposure(SampledFrame& frame, const SampleGrid& grid, EventOrientation orientation);

/// True when each frame uses 0..255 to the last with hardly a pixel at either end: its contrast was
/// stretched, by a factor and an offset of its own. A sensor's frames have a black level, or areas
/// that are saturated.
bool areStretched(const std::vector<TimingSample>& samples);

/// Exchanges ON and OFF.
void invertPolarity(TimingSample& sample);

/// Picks the samples out of a recording that is read once more. Of large sensors every n-th row is
/// taken: some ten thousand pixels say enough, and the estimate reads them hundreds of times.
class TimingSampler {
 public:
  /// \param size of the event sensor; frames may have it with the axes exchanged
  /// \param requests in the order of their frames
  TimingSampler(SensorSize size, const std::vector<SampleRequest>& requests);

  void addEvents(const WireEvents& events, SensorSize size);
  /// \param frame with its stamp and lengths; the pixels are read here if they are needed
  /// \param index counted among all frames
  void addFrame(std::size_t index, const SampledFrame& frame, const ImageView& image);

  /// Those that are complete. Empties the sampler.
  std::vector<TimingSample> take();
  const SampleGrid& grid() const { return grid_; }

 private:
  struct Slot {
    SampleRequest request;
    TimingSample sample;
    bool has_first = false;
    bool has_second = false;
  };

  SampleGrid grid_;
  std::vector<Slot> slots_;
};

}  // namespace fast_edi
