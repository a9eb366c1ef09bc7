/// \file
/// What must hold for the pipeline whatever comes in, checked call by call: for tests with random
/// schedules and for fuzzers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi::testing {

/// Checks, from the inputs alone:
/// - each frame gives one output or is counted as suppressed, in the order of arrival;
/// - a frame whose output stamp is later than the last one of its epoch gives an output, any other
///   gives none (exact where `reference` equals `stamp_reference`, since output stamps are the
///   input's then; else within an exposure's length);
/// - stamps strictly increase within an epoch of the frames' clock;
/// - everything that came in is counted as used, dropped or waiting;
/// - memory stays within what max_buffered_events and the sensor's size allow;
/// - thresholds in force are finite and positive.
class ScheduleChecker {
 public:
  /// \param deblurrer, sink must outlive this object
  ScheduleChecker(const Deblurrer& deblurrer, const RecordingSink& sink)
      : deblurrer_(deblurrer), sink_(sink) {}

  /// Gives \p frame an owner of its own, by which its output is recognised, and takes note of it.
  /// To be called for each frame, just before Deblurrer::addFrame().
  InputFrame expect(InputFrame frame);
  /// To be called just before Deblurrer::pause().
  void expectPause();
  /// To be called for each event array, just before Deblurrer::addEvents().
  void expectEvents(std::size_t count);

  /// To be called after each call of the pipeline.
  /// \return what is wrong; empty if nothing is
  std::string fault();
  /// To be called after Deblurrer::finish().
  std::string faultAtEnd();

 private:
  struct Expected {
    std::shared_ptr<const void> owner;
    std::int64_t stamp_ns = 0;
    std::uint64_t epoch = 0;
    std::uint64_t pauses = 0;  ///< before it came
  };

  std::string outputFault();
  std::string suppressionFault(std::size_t from, std::size_t to) const;
  std::string countFault() const;
  std::string memoryFault() const;

  const Deblurrer& deblurrer_;
  const RecordingSink& sink_;
  std::vector<Expected> frames_;
  std::size_t next_ = 0;             ///< of frames_: the first one without output
  std::uint64_t gone_ = 0;           ///< frames without output before that one
  std::size_t checked_outputs_ = 0;  ///< of the sink's
  std::uint64_t epoch_ = 0;
  std::uint64_t pauses_ = 0;
  bool has_latest_ = false;
  std::int64_t latest_ns_ = 0;
  bool has_output_ = false;
  std::int64_t last_output_ns_ = 0;
  std::uint64_t output_epoch_ = 0;
  std::size_t largest_pixels_ = 0;
  std::size_t largest_array_ = 0;
  bool exact_ = true;  ///< output stamps were the input's ever since the start
};

}  // namespace fast_edi::testing
