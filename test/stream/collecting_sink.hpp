/// \file
/// What a StreamClient hands on, kept.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <tuple>
#include <variant>
#include <vector>

#include "stream/stream_client.hpp"

namespace fast_edi::testing {

class CollectingSink : public StreamSink {
 public:
  struct Content {
    int begun = 0;  ///< connections
    RecordedStream stream;
    std::vector<std::tuple<std::int64_t, int, int, bool>> events;  ///< t [ns], x, y, ON
    std::vector<ExposureInterval> frames;
    std::vector<std::uint8_t> pixels;  ///< of the last frame
    std::vector<std::int64_t> samples;
    std::vector<int> triggers;
  };

  void begin(const RecordedStream& stream) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++content_.begun;
    content_.stream = stream;
    changed_.notify_all();
  }

  void add(const RecordingItem& item) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      for (std::size_t i = 0; i < events->count; ++i) {
        const Event& event = events->data[i];
        content_.events.emplace_back(event.t_ns, event.x, event.y, event.on);
      }
    } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
      content_.frames.push_back(frame->exposure.value_or(ExposureInterval{}));
      content_.pixels.assign(frame->pixels, frame->pixels + frame->bytes);
    } else if (const auto* sample = std::get_if<RecordedImu>(&item.content)) {
      content_.samples.push_back(sample->t_ns);
    } else if (const auto* trigger = std::get_if<RecordedTrigger>(&item.content)) {
      content_.triggers.push_back(trigger->type);
    }
    changed_.notify_all();
  }

  /// Waits until \p condition holds, a minute at most. \return whether it does
  bool waitFor(const std::function<bool(const Content&)>& condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, std::chrono::minutes(1), [&] { return condition(content_); });
  }
  Content content() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return content_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Content content_;
};

}  // namespace fast_edi::testing
