/// \file
/// A recording whose items are handed to Python.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi::python {

/// Calls may come from several threads, which take turns.
class RecordingItems {
 public:
  /// \param unit_ns of the times that are handed out
  RecordingItems(std::unique_ptr<Recording> recording, std::int64_t unit_ns)
      : recording_(std::move(recording)), unit_ns_(unit_ns) {}

  /// For what does not change while it is read.
  const Recording& recording() const { return *recording_; }

  /// (stream, kind, content) of the next item, None at the end; content by kind:
  /// "events": (structured array with x, y, t, p; arrays lost before); "frame": (image, stamp,
  /// exposure or None, encoding); "imu": (t, acceleration, angular velocity). Other items are left
  /// out. Reads without the interpreter's lock.
  pybind11::object next();

  /// So far. To be called without the interpreter's lock.
  std::vector<RecordingDamage> damage();

 private:
  std::mutex mutex_;
  std::unique_ptr<Recording> recording_;
  const std::int64_t unit_ns_;
};

}  // namespace fast_edi::python
