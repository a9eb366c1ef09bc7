/// \file
/// From the events of a recording to those of its frames, where a converter or a mount has turned
/// one of them against the other: orientation of the pixels, meaning of the polarity.
///
/// The words say what is done to the events so that they fit the frame. For an event at (x, y) of a
/// W x H sensor, as the event array states it, origin top left:
///
///     normal       (x, y)                          W x H
///     flip_x       (W-1-x, y)       left, right    W x H
///     flip_y       (x, H-1-y)       top, bottom    W x H
///     rotate_180   (W-1-x, H-1-y)                  W x H
///     transpose    (y, x)           main diagonal  H x W
///     rotate_90    (H-1-y, x)       clockwise      H x W
///     rotate_270   (y, W-1-x)       clockwise      H x W
///     transverse   (H-1-y, W-1-x)   other diagonal H x W
///
/// What lies outside of the sensor lies outside afterwards, too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

enum class EventPolarity {
  kNormal,    ///< ON: brighter
  kInverted,  ///< ON: darker
};

enum class EventOrientation {
  kNormal,
  kFlipX,
  kFlipY,
  kRotate180,
  kTranspose,
  kRotate90,
  kRotate270,
  kTransverse,
};

/// With the words of the parameter `event_orientation`.
constexpr std::array<std::pair<const char*, EventOrientation>, 8> kEventOrientations{{
    {"normal", EventOrientation::kNormal},
    {"flip_x", EventOrientation::kFlipX},
    {"flip_y", EventOrientation::kFlipY},
    {"rotate_180", EventOrientation::kRotate180},
    {"transpose", EventOrientation::kTranspose},
    {"rotate_90", EventOrientation::kRotate90},
    {"rotate_270", EventOrientation::kRotate270},
    {"transverse", EventOrientation::kTransverse},
}};

struct EventMapping {
  EventPolarity polarity = EventPolarity::kNormal;
  EventOrientation orientation = EventOrientation::kNormal;

  bool isIdentity() const {
    return polarity == EventPolarity::kNormal && orientation == EventOrientation::kNormal;
  }
  /// Of the sensor as the frames show it. \param size as the event arrays state it
  SensorSize apply(SensorSize size) const;
  Event apply(Event event, SensorSize size) const;
  /// The same for wire records, in place.
  void apply(std::uint8_t* records, std::size_t count, SensorSize size) const;

  friend bool operator==(const EventMapping& a, const EventMapping& b) {
    return a.polarity == b.polarity && a.orientation == b.orientation;
  }
  friend bool operator!=(const EventMapping& a, const EventMapping& b) { return !(a == b); }
};

/// The word for it.
const char* toString(EventOrientation orientation);

}  // namespace fast_edi
