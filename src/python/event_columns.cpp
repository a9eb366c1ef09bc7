#include "python/event_columns.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "python/time_unit.hpp"

namespace fast_edi::python {
namespace {

namespace py = pybind11;

/// Few enough for the first cache, with four columns.
constexpr std::size_t kBlockEvents = 512;
template <typename Number>
using Block = std::array<Number, kBlockEvents>;

/// What does not fit into \p Number becomes -1, which is refused.
template <typename Number, typename Integer>
Number narrowed(Integer value) {
  if constexpr (sizeof(Integer) < sizeof(Number) ||
                (sizeof(Integer) == sizeof(Number) && std::is_signed_v<Integer>)) {
    // A number, not a letter. NOLINTNEXTLINE(bugprone-signed-char-misuse)
    return static_cast<Number>(value);
  } else {
    const auto number = static_cast<Number>(value);
    return number >= 0 && static_cast<Integer>(number) == value ? number : Number{-1};
  }
}

template <typename Integer, typename Number>
void readAs(const char* items, std::ptrdiff_t stride, std::size_t count, Block<Number>& block) {
  for (std::size_t i = 0; i < count; ++i) {
    Integer value = 0;
    // Items of packed records are not aligned.
    std::memcpy(&value, items + static_cast<std::ptrdiff_t>(i) * stride, sizeof(value));
    block[i] = narrowed<Number>(value);
  }
}

template <typename Integer, typename Number>
void readColumn(const IntegerColumn& column, std::size_t begin, std::size_t count,
                Block<Number>& block) {
  const char* items = column.data + static_cast<std::ptrdiff_t>(begin) * column.stride;
  if (column.stride == sizeof(Integer)) {
    readAs<Integer>(items, sizeof(Integer), count, block);  // vectorised
  } else {
    readAs<Integer>(items, column.stride, count, block);
  }
}

template <typename Number>
void read(const IntegerColumn& column, std::size_t begin, std::size_t count, Block<Number>& block) {
  const bool is_signed = column.kind == 'i';
  switch (column.item_bytes) {
    case sizeof(std::int8_t):
      return is_signed ? readColumn<std::int8_t>(column, begin, count, block)
                       : readColumn<std::uint8_t>(column, begin, count, block);
    case sizeof(std::int16_t):
      return is_signed ? readColumn<std::int16_t>(column, begin, count, block)
                       : readColumn<std::uint16_t>(column, begin, count, block);
    case sizeof(std::int32_t):
      return is_signed ? readColumn<std::int32_t>(column, begin, count, block)
                       : readColumn<std::uint32_t>(column, begin, count, block);
    default:
      return is_signed ? readColumn<std::int64_t>(column, begin, count, block)
                       : readColumn<std::uint64_t>(column, begin, count, block);
  }
}

/// Four columns of up to kBlockEvents events.
struct EventBlock {
  Block<std::int32_t> x;
  Block<std::int32_t> y;
  Block<std::int64_t> t;
  Block<std::int32_t> p;
};

/// What values may be.
struct EventLimits {
  std::int32_t last_x = 0;
  std::int32_t last_y = 0;
  std::int64_t last_time = 0;
  std::int64_t unit_ns = 1;  ///< of times
};

/// Whether one of the events is to be refused, without branches, so that it costs little.
/// \param before time of the event before
bool anyRefused(const EventBlock& block, std::size_t count, const EventLimits& limits,
                std::int64_t before) {
  int outside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    outside |= static_cast<int>(block.x[i] < 0) | static_cast<int>(block.x[i] > limits.last_x) |
               static_cast<int>(block.y[i] < 0) | static_cast<int>(block.y[i] > limits.last_y) |
               static_cast<int>(block.p[i] < -1) | static_cast<int>(block.p[i] > 1);
  }
  int backwards = static_cast<int>(block.t[0] < before);
  for (std::size_t i = 1; i < count; ++i) {
    backwards |= static_cast<int>(block.t[i] < block.t[i - 1]);
  }
  return (outside | backwards) != 0 || block.t[count - 1] > limits.last_time;
}

[[noreturn]] void refuse(const IntegerColumn& column, std::size_t index, std::int64_t found,
                         const std::string& expected) {
  throw std::invalid_argument(column.name + "[" + std::to_string(index) + "] is " +
                              std::to_string(found) + ", expected " + expected);
}

/// \param value as a block has it, which may be narrower than the column's own number
void requireWithin(const IntegerColumn& column, std::size_t index, std::int64_t value,
                   std::int64_t lowest, std::int64_t highest, const std::string& expected) {
  if (value < lowest || value > highest) {
    Block<std::int64_t> own;
    read(column, index, 1, own);
    refuse(column, index, own[0], expected);
  }
}

std::string upTo(std::int64_t highest) {
  return "0.." + std::to_string(highest);
}

/// Finds what anyRefused() has noticed, and says so.
void requireAccepted(const EventColumns& columns, std::size_t begin, std::size_t count,
                     const EventBlock& block, const EventLimits& limits, std::int64_t before) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = begin + i;
    requireWithin(columns.x, index, block.x[i], 0, limits.last_x, upTo(limits.last_x));
    requireWithin(columns.y, index, block.y[i], 0, limits.last_y, upTo(limits.last_y));
    requireWithin(columns.t, index, block.t[i], 0, limits.last_time, expectedTime(limits.unit_ns));
    if (block.t[i] < before) {
      refuse(columns.t, index, block.t[i],
             "no less than " + std::to_string(before) + " before it: events in order of time");
    }
    requireWithin(columns.p, index, block.p[i], -1, 1, "0 or 1, or -1 and 1");
    before = block.t[i];
  }
}

/// Straight into the records that the pipeline reads; see event_wire.hpp for their layout.
void writeRecords(const EventBlock& block, std::size_t count, std::int64_t unit_ns,
                  std::uint8_t* record) {
  static_assert(kWireEventBytes == 2 * sizeof(std::uint16_t) + 2 * sizeof(std::uint32_t) + 1);
  std::int64_t second = 0;
  for (std::size_t i = 0; i < count; ++i, record += kWireEventBytes) {
    const std::int64_t t_ns = block.t[i] * unit_ns;
    if (t_ns - second * kNanosecondsPerSecond >= kNanosecondsPerSecond) {
      second = t_ns / kNanosecondsPerSecond;
    }
    const std::array<std::uint16_t, 2> pixel = {static_cast<std::uint16_t>(block.x[i]),
                                                static_cast<std::uint16_t>(block.y[i])};
    const std::array<std::uint32_t, 2> time = {
        static_cast<std::uint32_t>(second),
        static_cast<std::uint32_t>(t_ns - second * kNanosecondsPerSecond)};
    std::memcpy(record, pixel.data(), sizeof(pixel));
    std::memcpy(record + sizeof(pixel), time.data(), sizeof(time));
    record[sizeof(pixel) + sizeof(time)] = block.p[i] > 0 ? 1 : 0;
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

WireEvents readEvents(const EventColumns& columns, SensorSize size, std::int64_t unit_ns,
                      std::vector<std::uint8_t>& records) {
  for (const IntegerColumn* column : {&columns.y, &columns.t, &columns.p}) {
    requireSameLength(*column, columns.x);
  }
  const std::size_t total = columns.x.count;
  if (records.size() < total * kWireEventBytes) {
    records.resize(total * kWireEventBytes);
  }
  const EventLimits limits = {size.width - 1, size.height - 1, lastTime(unit_ns), unit_ns};
  std::int64_t before = 0;
  std::uint8_t* record = records.data();
  EventBlock block{};
  for (std::size_t begin = 0; begin < total; begin += kBlockEvents) {
    const std::size_t count = std::min(kBlockEvents, total - begin);
    read(columns.x, begin, count, block.x);
    read(columns.y, begin, count, block.y);
    read(columns.t, begin, count, block.t);
    read(columns.p, begin, count, block.p);
    if (anyRefused(block, count, limits, before)) {
      requireAccepted(columns, begin, count, block, limits, before);
    }
    writeRecords(block, count, unit_ns, record);
    record += count * kWireEventBytes;
    before = block.t[count - 1];
  }
  return {records.data(), total};
}

}  // namespace fast_edi::python
