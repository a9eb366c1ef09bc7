/// \file
/// Deblurring a recording in steps, one behind the other or on several threads:
///
///     read -> integrate -> filter -> write
///
/// Each message is read, copied to the output and integrated, in the order of the recording; what
/// it completes is filtered and written behind it. Only filtering is done for several frames at a
/// time, since no frame depends on the filtered ones before. Integrating does: thresholds and delay
/// are learned from pairs of frames, before any filter. So the output is the same for any number of
/// threads.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <ros/time.h>

#include "bags/message_batch.hpp"
#include "fast_edi/bags/bag_pipeline.hpp"
#include "fast_edi/filters/filter_parameters.hpp"

namespace fast_edi {

/// Each step is called by one thread at a time; different ones may run at the same time.
struct DeblurSteps {
  using Outputs = std::vector<BagPipeline::Output>;

  /// Asked before each message; once it says yes, the recording ends before that.
  std::function<bool()> stops;
  /// \return false at the end
  std::function<bool(ReadMessage& message)> read;
  /// \return what the message has completed, with work left to do or without
  std::function<Outputs(const BagMessage& message)> integrate;
  /// \return what the end of the recording completes
  std::function<Outputs()> finish;
  std::function<void(const ReadMessage& message)> copy;
  /// \param output without work left to do
  std::function<void(const BagPipeline::Output& output, const ros::Time& record_time)> write;
  FilterParameters filter;  ///< of what integrate() leaves to do
};

/// On the calling thread alone.
void deblurStepByStep(const DeblurSteps& steps);

/// On several threads, the calling one among them: whichever is free takes the next step.
///
/// Memory beyond that of one thread: messages that were read and messages and images that are to be
/// written, 16 MiB each for each thread and what one step adds; the filters of each thread; for
/// each thread two frames that wait to be filtered, with the events of their exposures.
/// \throws what a step has thrown, the first one. What read() throws comes when everything before
///         it has been written
void deblurOnThreads(const DeblurSteps& steps, std::size_t threads);

}  // namespace fast_edi
