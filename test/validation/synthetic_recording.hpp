/// \file
/// A recording of random events and empty frames, for checks that do not look at pixels.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "fast_edi/events/event_wire.hpp"
#include "survey/finding.hpp"
#include "survey/recording_survey.hpp"

namespace fast_edi::testing {

/// Events on 16 x 16 pixels at 100 per ms in arrays of 10 ms, frames every 40 ms exposed for 20 ms,
/// stamped mid-exposure, each with its exposure message. Faults are set before run().
struct SyntheticRecording {
  static constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
  static constexpr std::int64_t kStart = 1'700'000'000 * kNanosecondsPerSecond;
  static constexpr SensorSize kSize{16, 16};

  int frames = 12;
  AssumedParameters parameters;
  std::function<bool(std::int64_t since_start_ns)> has_event = [](std::int64_t) { return true; };
  std::function<std::int64_t(std::int64_t t_ns)> event_stamp = [](std::int64_t t) { return t; };
  std::function<void(int i, FrameMessage& frame)> change_frame = [](int, FrameMessage&) {};
  std::function<bool(int i)> has_array = [](int) { return true; };
  /// What the exposure message of frame i says, negative = none [us].
  std::function<std::int32_t(int i)> exposure_us = [](int) { return 20'000; };

  RecordingSurvey run() const {
    RecordingSurvey survey(parameters);
    std::mt19937 random(1);
    for (int array = 0; array < 4 * frames + 2; ++array) {
      const std::int64_t begin = array * 10 * kMs;
      std::vector<std::uint8_t> wire;
      std::size_t count = 0;
      for (std::int64_t t = begin; t < begin + 10 * kMs; t += kMs / 100) {
        if (has_event(t)) {
          encodeWireEvent(
              {static_cast<std::uint16_t>(random() % 16), static_cast<std::uint16_t>(random() % 16),
               event_stamp(kStart + t), random() % 2 == 0},
              wire);
          ++count;
        }
      }
      if (has_array(array)) {
        survey.addEvents({wire.data(), count}, kSize, static_cast<std::uint32_t>(array),
                         kStart + begin + 11 * kMs);
      }
      // Exposure i begins at 10 + 40 i ms.
      if (array % 4 == 3 && array / 4 < frames) {
        addFrame(survey, array / 4);
      }
    }
    survey.finish();
    return survey;
  }

 private:
  void addFrame(RecordingSurvey& survey, int i) const {
    FrameMessage frame;
    frame.stamp_ns = kStart + (20 + 40 * i) * kMs;
    frame.record_ns = frame.stamp_ns + 15 * kMs;
    frame.sequence = static_cast<std::uint32_t>(i);
    frame.size = kSize;
    change_frame(i, frame);
    survey.addFrame(frame);
    if (exposure_us(i) >= 0) {
      survey.addExposure(exposure_us(i), frame.record_ns + kMs / 10);
    }
  }
};

/// Names of findings, in order.
inline std::vector<std::string> namesOf(const std::vector<Finding>& findings) {
  std::vector<std::string> names;
  for (const Finding& finding : findings) {
    names.push_back(finding.name);
  }
  return names;
}

}  // namespace fast_edi::testing
