/// \file
/// Blends each latent image with the previous one, propagated by the events between the two.
///
/// With L1' the previous output, T1 and T2 the lengths of both exposures and l the
/// change of a pixel's level between both references (see level_model.hpp),
///
///     P = L1' exp(l) T2 / T1,    L2' = L2 + w (P - L2)
///
/// Consecutive images then agree better with the events between them, on which event-based trackers
/// rely. Each single image is farther from the truth: P has the noise of all events in between.
/// Pixels that are saturated in either image are not changed.
///
/// Complexity. O(events between both references + pixels). Memory once used: 24 B per pixel and two
/// images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/integral/latent_gains.hpp"
#include "fast_edi/latent/camera_response.hpp"

namespace fast_edi {

class TemporalFusion {
 public:
  /// Over a longer gap, the image propagated by events is too uncertain to be of use.
  static constexpr std::int64_t kMaxGap_ns = kNanosecondsPerSecond;

  /// What is needed of a frame to propagate its image to the next one.
  struct Frame {
    LevelInstant reference;        ///< of the image, in event time
    std::int64_t exposure_ns = 0;  ///< > 0
    std::uint64_t epoch = 0;       ///< of the frames' clock
  };

  /// \param image latent image of the frame; changed in place, unless there is no previous one, or
  ///        events between the two are missing
  /// \param weight w, within limits::kFilterTemporal
  /// \return whether it was blended
  bool apply(const Frame& frame, const EventStream& events, const LatentGains::Model& model,
             const CameraResponse& response, double weight, const MutableImageView& image);

  /// The next image has no previous one.
  void reset() { last_.clear(); }

  std::size_t memoryBytes() const;

 private:
  bool isBridged(const Frame& frame, const EventStream& events,
                 const MutableImageView& image) const;
  void blend(float weight, const MutableImageView& image);

  Frame last_frame_;
  std::uint64_t last_generation_ = 0;  ///< of the event lists
  StoredImage last_;                   ///< the previous output; empty: none
  StoredImage carried_;
  LatentGains change_;
  std::vector<float> gain_;
  std::vector<float> own_plane_;
  std::vector<float> carried_plane_;
};

}  // namespace fast_edi
