/// \file
/// Events in numpy arrays, one array for each of x, y, time and polarity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <pybind11/numpy.h>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"

namespace fast_edi::python {

/// The memory of a one-dimensional array of integers. Owns nothing.
struct IntegerColumn {
  std::string name;  ///< of the argument, for messages
  const char* data = nullptr;
  std::ptrdiff_t stride = 0;  ///< bytes; any
  char kind = 'i';            ///< numpy's letter: 'b', 'i' or 'u'
  std::size_t item_bytes = 0;
  std::size_t count = 0;
};

/// \throws pybind11::type_error unless \p array holds integers or booleans in native byte order
/// \throws std::invalid_argument unless it has one dimension
IntegerColumn integerColumn(const std::string& name, const pybind11::array& array);

/// The four columns of an event array, which read \p count events.
struct EventColumns {
  IntegerColumn x;
  IntegerColumn y;
  IntegerColumn t;
  IntegerColumn p;
};

/// Each number is read once, so that another thread that writes to the arrays changes events, but
/// cannot get past the checks. Needs no lock of the interpreter.
/// \param unit_ns of the times
/// \param records memory for the events; grows where they do not fit
/// \return all events, within \p records
/// \throws std::invalid_argument naming the argument, the index, what was found and what was
///         expected: equal lengths, pixels on the sensor, times that are stamps and never decrease,
///         polarity 0 or 1 (or -1 and 1)
WireEvents readEvents(const EventColumns& columns, SensorSize size, std::int64_t unit_ns,
                      std::vector<std::uint8_t>& records);

}  // namespace fast_edi::python
