/// \file
/// A recording through the pipeline: what the nodelet does live, over a bag in the order of its
/// record times, at full speed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include <ros/time.h>

#include "fast_edi/bags/bag_pipeline.hpp"
#include "fast_edi/bags/bag_writer.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {

/// What a run did.
struct BagDeblurReport {
  DeblurCounters counters;
  ClockPair differing_clocks;            ///< see DeblurStatus
  std::uint64_t messages = 0;            ///< copied
  std::uint64_t outputs = 0;             ///< frames put out
  std::uint64_t malformed_messages = 0;  ///< on a topic of ours, but unreadable: copied, not used
  ContrastThresholds given_thresholds;
  ContrastThresholds thresholds;    ///< in force at the end: given or learned
  std::int64_t event_delay_ns = 0;  ///< the same
  int learned_pairs = 0;            ///< of frames that these were learned from; 0: given
  double seconds = 0.0;             ///< wall clock
  ros::Time last_record_time;       ///< of the last readable message
  bool interrupted = false;         ///< ended before the end of the input, because asked to
  std::vector<BagDamage> damage;

  /// Events per wall-clock second [1/us].
  double eventsPerMicrosecond() const;
  /// Something of the input could not be used.
  bool incomplete() const { return !damage.empty() || malformed_messages > 0; }
};

/// For people: what came in, what went out, and why a frame was not deblurred.
void printSummary(std::ostream& out, const BagDeblurReport& report);

class BagDeblurrer {
 public:
  /// \param done, total messages
  using Progress = std::function<void(std::uint64_t done, std::uint64_t total)>;
  using OutputHandler = std::function<void(const BagPipeline::Output& output)>;
  using StopRequest = std::function<bool()>;

  /// \param reader must outlive this object
  /// \param writer must outlive this object; null: no bag is written
  /// \throws std::invalid_argument for parameters out of range
  BagDeblurrer(MessageSource& reader, BagWriter* writer, const TopicNames& topics,
               const LoadedParameters& parameters, Progress progress);

  /// Shows every output to \p handler as well, which may throw: run() then ends with that.
  void setOutputHandler(OutputHandler handler) { output_handler_ = std::move(handler); }

  /// Outputs shown to the handler have maps of trust.
  void showTrust() { pipeline_.showTrust(); }

  /// On how many threads run() works at a time, 1 by default: same output. With more, what was set
  /// above is called by other threads than run(), each by one at a time.
  void setThreads(std::size_t threads);

  /// Asks \p requested before each message; once it says yes, run() behaves as at the end of the
  /// bag.
  void setStopRequest(StopRequest requested) { stop_requested_ = std::move(requested); }

  /// Copies every message and adds the deblurred frames, each behind the message that completed it
  /// and with the same record time. At the end of the bag waiting frames are closed with what has
  /// come. Latent images (`latent_images`) are written to TopicNames::outputLatent().
  /// Does not close the writer.
  /// \throws BagError when the output cannot be written, and what was set above throws
  BagDeblurReport run();

 private:
  void copy(const BagMessage& message);
  std::vector<BagPipeline::Output> integrate(const BagMessage& message);
  std::vector<BagPipeline::Output> finish();
  void write(const BagPipeline::Output& output, const ros::Time& record_time);

  MessageSource& reader_;
  BagWriter* const writer_;
  const std::string image_topic_;
  const std::string camera_info_topic_;
  const std::string latent_topic_;
  const bool write_latent_;
  const FilterParameters filter_;
  const Progress progress_;
  OutputHandler output_handler_;
  StopRequest stop_requested_;
  std::size_t threads_ = 1;
  BagPipeline pipeline_;
  BagDeblurReport report_;
};

}  // namespace fast_edi
