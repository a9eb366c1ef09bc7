/// Recordings of every format but rosbag, which has a fuzzer of its own: the input is the file.
/// Read as items, and as the messages that the tools get of it.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "fast_edi/bags/recording_messages.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "fuzz/fuzzing.hpp"

namespace {

using fast_edi::fuzzing::require;

/// A regular file in memory, which is faster than one on a disk.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("recording", 0)) {
    require(descriptor_ >= 0, "there is memory for a file");
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
  void fill(const std::uint8_t* data, std::size_t size) const {
    require(::ftruncate(descriptor_, 0) == 0 &&
                ::pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size),
            "a file in memory can be written");
  }

 private:
  int descriptor_;
};

const MemoryFile& inputFile() {
  static const MemoryFile file;
  return file;
}

/// Touches each byte that an item points to.
std::size_t sumOf(const fast_edi::RecordingItem& item) {
  std::size_t sum = 0;
  if (const auto* events = std::get_if<fast_edi::RecordedEvents>(&item.content)) {
    for (std::size_t i = 0; i < events->count; ++i) {
      require(fast_edi::isStamp(events->data[i].t_ns), "times of events can be stamped");
      sum += events->data[i].x;
    }
  } else if (const auto* frame = std::get_if<fast_edi::RecordedFrame>(&item.content)) {
    require(fast_edi::isStamp(frame->stamp_ns), "times of frames can be stamped");
    require(frame->size.width > 0 && frame->size.height > 0, "frames have a size");
    for (std::size_t i = 0; i < frame->bytes; ++i) {
      sum += frame->pixels[i];
    }
  }
  return sum;
}

void readItems(const std::string& path) {
  const std::unique_ptr<fast_edi::Recording> recording = fast_edi::openRecording(path);
  if (!recording) {
    return;
  }
  fast_edi::RecordingItem item;
  std::int64_t before_ns = 0;
  std::size_t sum = 0;
  while (recording->next(item)) {
    require(item.record_ns >= before_ns, "record times never go back");
    require(item.stream < recording->streams().size(), "items belong to a stream");
    before_ns = item.record_ns;
    sum += sumOf(item);
  }
  require(sum < SIZE_MAX, "all was read");
  for (const fast_edi::RecordingDamage& damage : recording->damage()) {
    require(!damage.what.empty(), "damage says what it is");
  }
}

void readMessages(const std::string& path) {
  std::unique_ptr<fast_edi::Recording> recording = fast_edi::openRecording(path);
  if (!recording) {
    return;
  }
  fast_edi::RecordingMessages messages(std::move(recording),
                                       10 * fast_edi::kNanosecondsPerMillisecond);
  fast_edi::BagMessage message;
  while (messages.next(message)) {
    require(message.connection != nullptr, "messages have a topic");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  inputFile().fill(data, size);
  try {
    readItems(inputFile().path());
    readMessages(inputFile().path());
  } catch (const fast_edi::RecordingError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
  return 0;
}
