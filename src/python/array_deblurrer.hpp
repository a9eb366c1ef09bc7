/// \file
/// The pipeline for arrays: the Deblurrer behind a lock, with the latest time that came in as its
/// clock, and a queue of what it has finished.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "python/event_columns.hpp"
#include "python/image_array.hpp"

namespace fast_edi::python {

struct LatentOutput {
  std::int64_t stamp_ns = 0;
  PixelBuffer image;
};

struct FrameOutput {
  OutputFrame frame;  ///< its input image is gone
  PixelBuffer image;
  int dimensions = 2;  ///< of the input array
  std::vector<LatentOutput> latent;
};

/// Keeps what it is given.
class ArraySink : public FrameSink {
 public:
  explicit ArraySink(bool video) : video_(video) {}

  MutableImageView begin(const InputFrame& input) override;
  void finish(const OutputFrame& output) override;
  bool wantsLatentImages() const override { return video_; }
  MutableImageView beginLatent(const InputFrame& input) override;
  void finishLatent(const InputFrame& input, std::int64_t stamp_ns) override;

  std::vector<FrameOutput> take() { return std::exchange(outputs_, {}); }

 private:
  const bool video_;
  PixelBuffer buffer_;
  std::vector<FrameOutput> outputs_;
};

struct OwnedFrame;

/// Calls may come from several threads, which take turns; none needs the interpreter's lock.
class ArrayDeblurrer {
 public:
  /// \throws std::invalid_argument naming the parameter or size that is out of range
  ArrayDeblurrer(SensorSize size, std::int64_t unit_ns, const DeblurParameters& parameters);

  /// \param lost_arrays that came before these, but not to here
  /// \throws as readEvents(); then none of the events was taken
  void addEvents(const EventColumns& columns, std::uint32_t lost_arrays);
  /// Stamps are the middle of an exposure that comes with its frame, whatever the parameters say.
  void useRecordedExposures();
  /// Copies the pixels, so that the caller can use the memory for its next frame.
  /// \param exposure in units; nothing: not known
  /// \throws std::invalid_argument naming the argument that cannot be used; then the frame was not
  ///         taken
  void addFrame(const ImageView& image, int dimensions, std::int64_t stamp,
                std::optional<std::int64_t> exposure);
  /// Events are complete from here on, though none may come for a while.
  void beginAt(std::int64_t t);
  /// Events are complete up to here, though none may have come for a while.
  void endAt(std::int64_t t);
  void finish();
  std::vector<FrameOutput> take();

  DeblurCounters counters();
  DeblurStatus status();
  std::int64_t unit() const { return unit_ns_; }

 private:
  void addMark(std::int64_t t_ns);
  /// One that no frame in the pipeline has.
  std::shared_ptr<OwnedFrame> unusedFrame();
  std::int64_t advanceTo(std::int64_t t_ns);

  const SensorSize size_;
  const std::int64_t unit_ns_;
  std::mutex mutex_;  ///< guards all below
  ArraySink sink_;
  Deblurrer deblurrer_;
  std::vector<std::uint8_t> records_;  ///< memory for the events of a call
  /// As many as have waited at once: a new one costs as much time as the copy of the pixels.
  std::vector<std::shared_ptr<OwnedFrame>> frames_;
  std::int64_t now_ns_ = 0;
  std::uint32_t sequence_ = 0;  ///< number of the last event array
};

}  // namespace fast_edi::python
