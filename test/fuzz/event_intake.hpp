/// \file
/// What the fuzzer of event arrays does with its input, but for reading messages: the pipeline's
/// intake, and frames that make it use the events. Needs no ROS, so that the corpus can be run on
/// other processors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "fuzz/fuzzing.hpp"
#include "support/pipeline_input.hpp"
#include "support/schedule_checker.hpp"

namespace fast_edi::fuzzing {

/// What a message says, in memory that is the message's or the decoder's.
struct DecodedArray {
  WireEvents events;
  SensorSize size;
  std::uint32_t sequence = 0;
};

class EventIntake {
 public:
  EventIntake() : deblurrer_(parameters(), sink_), checker_(deblurrer_, sink_) {}

  void addArray(const DecodedArray& array) {
    size_ = array.size;
    if (!array.events.empty()) {
      newest_ns_ = decodeWireEvent(array.events.record(array.events.count - 1)).t_ns;
    }
    checker_.expectEvents(array.events.count);
    deblurrer_.addEvents(array.events, size_, array.sequence, now_ns_ += kTick_ns);
    requireNoFault(checker_.fault());
  }

  /// An array of kLargeArray events: those of \p array again and again, each time \p step_us later,
  /// or earlier, than the time before.
  void addLargeArray(const DecodedArray& array, std::int32_t step_us) {
    if (array.events.empty()) {
      return;
    }
    std::vector<std::uint8_t> records;
    records.reserve(kLargeArray * kWireEventBytes);
    for (std::size_t i = 0; i < kLargeArray; ++i) {
      Event event = decodeWireEvent(array.events.record(i % array.events.count));
      const auto round = static_cast<std::int64_t>(i / array.events.count);
      event.t_ns = std::clamp<std::int64_t>(
          event.t_ns + round * step_us * kNanosecondsPerMicrosecond, 0, kLastStamp_ns);
      encodeWireEvent(event, records);
    }
    addArray({{records.data(), kLargeArray}, array.size, array.sequence});
  }

  /// A frame whose exposure ends with the newest event.
  void addFrame() {
    if (size_.pixelCount() == 0 || size_.pixelCount() > kMaxFramePixels) {
      return;
    }
    deblurrer_.addFrame(checker_.expect(testing::makeFlatFrame(newest_ns_, size_)),
                        now_ns_ += kTick_ns);
    requireNoFault(checker_.fault());
  }

  void finish() {
    deblurrer_.finish();
    requireNoFault(checker_.faultAtEnd());
  }

 private:
  /// A frame of a larger sensor says nothing more about events and costs its time.
  static constexpr std::size_t kMaxFramePixels = 4096;
  static constexpr std::size_t kLargeArray = 100'000;
  static constexpr std::int64_t kTick_ns = 3 * kNanosecondsPerMillisecond;
  static constexpr std::int64_t kLastStamp_ns = UINT32_MAX * kNanosecondsPerSecond;

  static DeblurParameters parameters() {
    DeblurParameters parameters;
    parameters.thresholds = {0.3, 0.2};
    parameters.exposure_source = ExposureSource::kParameter;
    parameters.exposure_time_ns = 10 * kNanosecondsPerMillisecond;
    parameters.stamp_reference = ExposureInstant::kEnd;
    parameters.reference = ExposureInstant::kEnd;
    parameters.max_buffered_events = 1000;
    return parameters;
  }

  testing::RecordingSink sink_;
  Deblurrer deblurrer_;
  testing::ScheduleChecker checker_;
  SensorSize size_;
  std::int64_t newest_ns_ = 0;
  std::int64_t now_ns_ = 0;
};

/// Numbers and bytes from the front of an input, as many as there are.
class InputBytes {
 public:
  InputBytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  template <typename Number>
  std::optional<Number> number() {
    Number number{};
    if (size_ < sizeof(number)) {
      return std::nullopt;
    }
    std::memcpy(&number, data_, sizeof(number));
    skip(sizeof(number));
    return number;
  }

  /// At most \p most bytes, in memory of just that size, so that a sanitizer sees any byte read
  /// beyond it.
  std::vector<std::uint8_t> bytes(std::size_t most) {
    const std::size_t taken = std::min(most, size_);
    std::vector<std::uint8_t> bytes(data_, data_ + taken);
    skip(taken);
    return bytes;
  }

 private:
  void skip(std::size_t bytes) {
    data_ += bytes;
    size_ -= bytes;
  }

  const std::uint8_t* data_;
  std::size_t size_;
};

/// Input: messages one behind the other, each with its length in front (two bytes). One of length 0
/// asks for a frame instead. With kRepeat added to the length, a step [us] (four bytes) comes
/// before the message, and its events are repeated to a large array; only kMostLargeArrays of
/// these, which take their time. \param decode
/// std::optional<DecodedArray>(std::vector<std::uint8_t>& message): empty when refused
template <typename Decode>
void runEventArrays(InputBytes input, Decode decode) {
  constexpr std::uint16_t kRepeat = 0x8000;
  constexpr int kMostLargeArrays = 2;
  int large_arrays = 0;
  EventIntake intake;
  while (const auto head = input.number<std::uint16_t>()) {
    const bool repeat = (*head & kRepeat) != 0;
    const std::int32_t step_us = repeat ? input.number<std::int32_t>().value_or(0) : 0;
    std::vector<std::uint8_t> message = input.bytes(*head & (kRepeat - 1u));
    if (message.empty()) {
      intake.addFrame();
    } else if (const std::optional<DecodedArray> array = decode(message)) {
      if (!repeat) {
        intake.addArray(*array);
      } else if (++large_arrays <= kMostLargeArrays) {
        intake.addLargeArray(*array, step_us);
      }
    }
  }
  intake.finish();
}

}  // namespace fast_edi::fuzzing
