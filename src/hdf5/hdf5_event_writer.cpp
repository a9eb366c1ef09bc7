#include "hdf5/hdf5_event_writer.hpp"

namespace fast_edi {
namespace {

constexpr hsize_t kChunkEvents = 65'536;
constexpr std::int64_t kMicrosecondsPerMillisecond = 1000;
/// Entries of ms_to_idx: a day's. Beyond, a clock has jumped.
constexpr std::size_t kMaxMilliseconds = 86'400'000;

}  // namespace

Hdf5EventWriter::Hdf5EventWriter(const Hdf5Output& output) : output_(output) {
  const Hdf5Handle group = output_.makeGroup("events");
  x_ = output_.makeColumn(group, "x", H5T_STD_U16LE, kChunkEvents);
  y_ = output_.makeColumn(group, "y", H5T_STD_U16LE, kChunkEvents);
  t_ = output_.makeColumn(group, "t", H5T_STD_I64LE, kChunkEvents);
  polarity_ = output_.makeColumn(group, "p", H5T_STD_U8LE, kChunkEvents);
}

void Hdf5EventWriter::add(const Event& event) {
  const std::int64_t t_us = event.t_ns / kNanosecondsPerMicrosecond;
  if (!offset_us_) {
    offset_us_ = t_us / kMicrosecondsPerMillisecond * kMicrosecondsPerMillisecond;
  }
  const std::int64_t since_us = t_us - *offset_us_;
  while (first_of_ms_.size() < kMaxMilliseconds &&
         since_us >= static_cast<std::int64_t>(first_of_ms_.size()) * kMicrosecondsPerMillisecond) {
    first_of_ms_.push_back(written_ + waiting_.t_us.size());
  }
  waiting_.x.push_back(event.x);
  waiting_.y.push_back(event.y);
  waiting_.t_us.push_back(since_us);
  waiting_.polarity.push_back(event.on ? 1 : 0);
  if (waiting_.t_us.size() == kChunkEvents) {
    flush();
  }
}

void Hdf5EventWriter::flush() {
  const hsize_t count = waiting_.t_us.size();
  if (count == 0) {
    return;
  }
  output_.append(x_, written_, H5T_NATIVE_UINT16, waiting_.x.data(), count);
  output_.append(y_, written_, H5T_NATIVE_UINT16, waiting_.y.data(), count);
  output_.append(t_, written_, H5T_NATIVE_INT64, waiting_.t_us.data(), count);
  output_.append(polarity_, written_, H5T_NATIVE_UINT8, waiting_.polarity.data(), count);
  written_ += count;
  waiting_.x.clear();
  waiting_.y.clear();
  waiting_.t_us.clear();
  waiting_.polarity.clear();
}

void Hdf5EventWriter::finish() {
  flush();
  output_.writeNumber(output_.file(), "t_offset", offset_us_.value_or(0));
  output_.writeArray(output_.file(), "ms_to_idx", H5T_STD_U64LE, {first_of_ms_.size()},
                     H5T_NATIVE_UINT64, first_of_ms_.data());
}

}  // namespace fast_edi
