/// \file
/// Input and output of the pipeline, and the interface that receives the output.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/base/image.hpp"
#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// A frame as it came in. `owner` keeps the memory behind `image` alive and lets the sink find the
/// message it came from. The view of a frame that is not supported may be empty.
struct InputFrame {
  std::int64_t stamp_ns = 0;
  ImageView image;
  bool supported = true;  ///< false: the encoding is not one we deblur; passed through
  std::shared_ptr<const void> owner;
};

/// What became of a frame.
struct OutputFrame {
  InputFrame input;
  std::int64_t stamp_ns = 0;  ///< stamp of the output image, one that isStamp()
  bool deblurred = false;     ///< false: the output is a copy of the input
  PassReason pass_reason = PassReason::kPassthroughParameter;  ///< when !deblurred
  ExposureInterval exposure;  ///< in frame time; zero length when not known
  std::uint64_t events = 0;   ///< events inside the exposure
};

class FrameRenderer;

/// The rest of the work on one frame, the filters: to be done once, on any thread, at any time. It
/// holds all that it needs but the memory of the frame's output.
/// \return whether the renderer knows how far it trusted each pixel
using FrameWork = std::function<bool(FrameRenderer& renderer)>;

/// Receives the output. Called from within the Deblurrer's calls.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// Memory for the output of \p input: same size and format, written before finish(). An empty
  /// view for an empty view: what that frame's output holds is then the sink's own matter. Without
  /// filters (filter.enabled), frames may come without pixels and empty views be returned for all
  /// of them: then no image is rendered, and finish() says what would have become of the frame.
  virtual MutableImageView begin(const InputFrame& input) = 0;
  /// The memory handed out by the last begin() now holds the image that \p output describes.
  virtual void finish(const OutputFrame& output) = 0;

  /// How far filter_reblur trusted each pixel of the image that is being written, 0 to 1,
  /// row-major. Comes between begin() and finish(), of frames that it looked at.
  virtual void noteTrust(const std::vector<float>& trust) { static_cast<void>(trust); }

  /// Whether the sink takes work by defer(): asked for each deblurred frame.
  virtual bool takesWork() const { return false; }
  /// Comes between begin() and finish() in place of the image, which is complete when \p work is
  /// done; of frames that no later frame depends on.
  virtual void defer(const FrameWork& work) { static_cast<void>(work); }

  /// Whether anybody wants the high-rate video just now. Asked once for each deblurred frame; costs
  /// nothing while it says no.
  virtual bool wantsLatentImages() const { return false; }
  /// Memory for one image of it, as begin() for frames. Comes after the finish() of a frame, never
  /// between a begin() and its finish().
  /// \param input the frame that the image is computed from
  virtual MutableImageView beginLatent(const InputFrame& input) {
    static_cast<void>(input);
    return {};
  }
  /// The memory handed out by the last beginLatent() now holds the latent image of \p stamp_ns in
  /// frame time. Stamps increase strictly within an epoch of the frames' clock.
  virtual void finishLatent(const InputFrame& input, std::int64_t stamp_ns) {
    static_cast<void>(input);
    static_cast<void>(stamp_ns);
  }
};

}  // namespace fast_edi
