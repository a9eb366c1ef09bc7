#include "python/event_columns.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi::python {
namespace {

namespace py = pybind11;

constexpr std::size_t kBlockEvents = 1024;
using Block = std::array<std::int64_t, kBlockEvents>;

template <typename Integer>
void readAs(const IntegerColumn& column, std::size_t begin, std::size_t count, Block& block) {
  const char* item = column.data + static_cast<std::ptrdiff_t>(begin) * column.stride;
  for (std::size_t i = 0; i < count; ++i, item += column.stride) {
    Integer value = 0;
    std::memcpy(&value, item, sizeof(value));  // items of packed records are not aligned
    // A number, not a letter. NOLINTNEXTLINE(bugprone-signed-char-misuse)
    block[i] = static_cast<std::int64_t>(value);
  }
}

/// Numbers beyond 2^63 come out negative, which nothing here accepts either.
void read(const IntegerColumn& column, std::size_t begin, std::size_t count, Block& block) {
  const bool is_signed = column.kind == 'i';
  switch (column.item_bytes) {
    case sizeof(std::int8_t):
      return is_signed ? readAs<std::int8_t>(column, begin, count, block)
                       : readAs<std::uint8_t>(column, begin, count, block);
    case sizeof(std::int16_t):
      return is_signed ? readAs<std::int16_t>(column, begin, count, block)
                       : readAs<std::uint16_t>(column, begin, count, block);
    case sizeof(std::int32_t):
      return is_signed ? readAs<std::int32_t>(column, begin, count, block)
                       : readAs<std::uint32_t>(column, begin, count, block);
    default:
      return is_signed ? readAs<std::int64_t>(column, begin, count, block)
                       : readAs<std::uint64_t>(column, begin, count, block);
  }
}

[[noreturn]] void refuse(const IntegerColumn& column, std::size_t index, std::int64_t found,
                         const std::string& expected) {
  throw std::invalid_argument(column.name + "[" + std::to_string(index) + "] is " +
                              std::to_string(found) + ", expected " + expected);
}

void requireWithin(const IntegerColumn& column, std::size_t index, std::int64_t value,
                   std::int64_t highest) {
  if (value < 0 || value > highest) {
    refuse(column, index, value, "0.." + std::to_string(highest));
  }
}

void requireSameLength(const IntegerColumn& column, const IntegerColumn& first) {
  if (column.count != first.count) {
    throw std::invalid_argument(column.name + " has " + std::to_string(column.count) +
                                " elements, expected " + std::to_string(first.count) + " as in " +
                                first.name);
  }
}

}  // namespace

IntegerColumn integerColumn(const std::string& name, const py::array& array) {
  const char kind = array.dtype().kind();
  if (kind != 'i' && kind != 'u' && kind != 'b') {
    throw py::type_error(name + " has dtype " + std::string(py::str(array.dtype())) +
                         ", expected an integer one");
  }
  if (array.ndim() != 1) {
    throw std::invalid_argument(name + " has " + std::to_string(array.ndim()) +
                                " dimensions, expected 1");
  }
  IntegerColumn column;
  column.name = name;
  column.data = static_cast<const char*>(array.data());
  column.stride = array.strides(0);
  column.kind = kind;
  column.item_bytes = static_cast<std::size_t>(array.itemsize());
  column.count = static_cast<std::size_t>(array.size());
  return column;
}

void readEvents(const EventColumns& columns, SensorSize size, std::int64_t unit_ns,
                std::vector<Event>& events) {
  for (const IntegerColumn* column : {&columns.y, &columns.t, &columns.p}) {
    requireSameLength(*column, columns.x);
  }
  events.resize(columns.x.count);
  const std::int64_t last_time = kLastStamp_ns / unit_ns;
  std::int64_t before = 0;
  Block x;
  Block y;
  Block t;
  Block p;
  for (std::size_t begin = 0; begin < events.size(); begin += kBlockEvents) {
    const std::size_t count = std::min(kBlockEvents, events.size() - begin);
    read(columns.x, begin, count, x);
    read(columns.y, begin, count, y);
    read(columns.t, begin, count, t);
    read(columns.p, begin, count, p);
    for (std::size_t i = 0; i < count; ++i) {
      requireWithin(columns.x, begin + i, x[i], size.width - 1);
      requireWithin(columns.y, begin + i, y[i], size.height - 1);
      requireWithin(columns.t, begin + i, t[i], last_time);
      if (t[i] < before) {
        refuse(columns.t, begin + i, t[i],
               "no less than " + std::to_string(before) + " before it: events in order of time");
      }
      if (p[i] < -1 || p[i] > 1) {
        refuse(columns.p, begin + i, p[i], "0 or 1, or -1 and 1");
      }
      before = t[i];
      events[begin + i] = {static_cast<std::uint16_t>(x[i]), static_cast<std::uint16_t>(y[i]),
                           t[i] * unit_ns, p[i] > 0};
    }
  }
}

}  // namespace fast_edi::python
