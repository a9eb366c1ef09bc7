#include "bags/deblur_steps.hpp"

#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "pipeline/frame_renderer.hpp"
#include "stages/worker_crew.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kBytesPerThread = std::size_t{16} << 20;
constexpr std::size_t kWaitingFramesPerThread = 2;
/// Emptied batches that are kept, unless a huge message has blown them up.
constexpr std::size_t kSpareBatches = 4;
constexpr std::size_t kSpareBytes = std::size_t{4} << 20;

/// Which steps can be taken, and what they have left behind. The crew calls it by one thread at a
/// time, apart from the work of the steps.
class ThreadedSteps {
 public:
  ThreadedSteps(const DeblurSteps& steps, std::size_t threads)
      : steps_(steps), threads_(threads), crew_([this] { return choose(); }) {}

  void run() {
    crew_.run(threads_);
    if (read_failure_) {
      std::rethrow_exception(read_failure_);
    }
  }

 private:
  using Step = WorkerCrew::Step;
  using Output = BagPipeline::Output;

  struct Batch {
    MessageBatch messages;
    std::exception_ptr read_failure;  ///< comes behind the messages
    bool is_last = false;
    std::size_t bytes = 0;
    std::size_t unfiltered = 0;  ///< frames
  };
  struct Frame {
    std::shared_ptr<Batch> batch;
    Output* output;
  };
  /// Steps of which there is one at a time.
  struct Busy {
    bool reading = false;
    bool integrating = false;
    bool writing = false;
  };

  /// Those that free memory come first.
  std::optional<Step> choose() {
    if (!busy_.writing && !integrated_.empty() && integrated_.front()->unfiltered == 0) {
      return write();
    }
    if (!frames_.empty()) {
      return filter();
    }
    if (!busy_.integrating && integrated_bytes_ < threads_ * kBytesPerThread &&
        frames_.size() < threads_ * kWaitingFramesPerThread) {
      if (!read_.empty()) {
        return integrate();
      }
      if (has_read_all_ && !busy_.reading && !is_finished_) {
        return finish();
      }
    }
    if (!busy_.reading && !has_read_all_ && read_bytes_ < threads_ * kBytesPerThread) {
      return read();
    }
    return std::nullopt;
  }

  Step read() {
    busy_.reading = true;
    const auto batch = std::make_shared<Batch>();
    if (!spare_.empty()) {
      batch->messages = std::move(spare_.back());
      spare_.pop_back();
    }
    return {[this, batch] { fill(*batch); },
            [this, batch] {
              busy_.reading = false;
              if (has_read_all_) {
                return;  // it was stopped meanwhile
              }
              has_read_all_ = batch->is_last;
              read_failure_ = batch->read_failure;
              batch->bytes = batch->messages.bytes();
              read_bytes_ += batch->bytes;
              read_.push_back(batch);
            }};
  }

  void fill(Batch& batch) const {
    try {
      ReadMessage message;
      while (!batch.messages.isFull() && !batch.is_last) {
        if (steps_.read(message)) {
          batch.messages.add(message);
        } else {
          batch.is_last = true;
        }
      }
    } catch (...) {
      batch.read_failure = std::current_exception();
      batch.is_last = true;
    }
    batch.messages.complete();
  }

  Step integrate() {
    const std::shared_ptr<Batch> batch = read_.front();
    read_.pop_front();
    read_bytes_ -= batch->bytes;
    return integrateBy(batch, [this, batch] {
      std::vector<MessageBatch::Entry>& entries = batch->messages.entries();
      for (std::size_t i = 0; i < entries.size(); ++i) {
        if (steps_.stops()) {
          batch->messages.endBefore(i);
          batch->is_last = true;
          return;
        }
        last_time_ = entries[i].read.message.time;
        entries[i].outputs = steps_.integrate(entries[i].read.message);
      }
    });
  }

  /// The end of the recording, unless its reading has failed.
  Step finish() {
    is_finished_ = true;
    const auto batch = std::make_shared<Batch>();
    return integrateBy(batch, [this, batch] {
      if (!read_failure_) {
        batch->messages.addEnd(last_time_);
        batch->messages.entries().back().outputs = steps_.finish();
      }
    });
  }

  Step integrateBy(const std::shared_ptr<Batch>& batch, std::function<void()> work) {
    busy_.integrating = true;
    return {std::move(work), [this, batch] {
              busy_.integrating = false;
              if (batch->is_last && !read_.empty()) {
                read_.clear();  // it was stopped
              }
              has_read_all_ = has_read_all_ || batch->is_last;
              batch->bytes = batch->messages.bytes();
              integrated_bytes_ += batch->bytes;
              integrated_.push_back(batch);
              for (MessageBatch::Entry& entry : batch->messages.entries()) {
                for (Output& output : entry.outputs) {
                  if (output.work) {
                    frames_.push_back({batch, &output});
                    ++batch->unfiltered;
                  }
                }
              }
            }};
  }

  Step filter() {
    const Frame frame = frames_.front();
    frames_.pop_front();
    const std::shared_ptr<FrameRenderer> renderer = takeRenderer();
    return {[frame, renderer] { BagPipeline::complete(*frame.output, *renderer); },
            [this, frame, renderer] {
              --frame.batch->unfiltered;
              renderers_.push_back(renderer);
            }};
  }

  std::shared_ptr<FrameRenderer> takeRenderer() {
    if (renderers_.empty()) {
      return std::make_shared<FrameRenderer>(steps_.filter);
    }
    std::shared_ptr<FrameRenderer> renderer = std::move(renderers_.back());
    renderers_.pop_back();
    return renderer;
  }

  Step write() {
    busy_.writing = true;
    const std::shared_ptr<Batch> batch = integrated_.front();
    integrated_.pop_front();
    return {[this, batch] {
              for (const MessageBatch::Entry& entry : batch->messages.entries()) {
                writeEntry(entry);
              }
            },
            [this, batch] {
              busy_.writing = false;
              integrated_bytes_ -= batch->bytes;
              if (spare_.size() < kSpareBatches && batch->messages.capacity() <= kSpareBytes) {
                batch->messages.clear();
                spare_.push_back(std::move(batch->messages));
              }
            }};
  }

  void writeEntry(const MessageBatch::Entry& entry) const {
    if (entry.read.message.connection != nullptr) {
      steps_.copy(entry.read);
    }
    for (const Output& output : entry.outputs) {
      steps_.write(output, entry.read.message.time);
    }
  }

  const DeblurSteps& steps_;
  const std::size_t threads_;
  WorkerCrew crew_;
  std::deque<std::shared_ptr<Batch>> read_;                ///< to be integrated
  std::deque<Frame> frames_;                               ///< to be filtered
  std::deque<std::shared_ptr<Batch>> integrated_;          ///< to be written
  std::vector<MessageBatch> spare_;                        ///< for reading, with their memory
  std::vector<std::shared_ptr<FrameRenderer>> renderers_;  ///< that nobody uses just now
  std::size_t read_bytes_ = 0;
  std::size_t integrated_bytes_ = 0;  ///< of those being written, too
  Busy busy_;
  bool has_read_all_ = false;
  bool is_finished_ = false;
  ros::Time last_time_;              ///< of the message integrated last
  std::exception_ptr read_failure_;  ///< comes behind all that was read before
};

}  // namespace

void deblurStepByStep(const DeblurSteps& steps) {
  FrameRenderer renderer(steps.filter);
  const auto write = [&](DeblurSteps::Outputs outputs, const ros::Time& record_time) {
    for (BagPipeline::Output& output : outputs) {
      BagPipeline::complete(output, renderer);
      steps.write(output, record_time);
    }
  };
  ReadMessage message;
  while (!steps.stops() && steps.read(message)) {
    steps.copy(message);
    write(steps.integrate(message.message), message.message.time);
  }
  write(steps.finish(), message.message.time);
}

void deblurOnThreads(const DeblurSteps& steps, std::size_t threads) {
  ThreadedSteps(steps, threads).run();
}

}  // namespace fast_edi
