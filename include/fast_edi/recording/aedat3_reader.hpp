/// \file
/// AEDAT 3.1, the format of cAER
/// (https://docs.inivation.com/software/software-advanced-usage/file-formats/aedat-3.1.html), of
/// DAVIS cameras.
///
/// Lines that begin with `#` up to `#!END-HEADER`, then packets of events of one kind. A frame has
/// start and end of its exposure. Event by event is read, so that no stated size makes room for a
/// packet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

class Aedat3Reader : public Recording {
 public:
  /// More events of one packet come in several items.
  static constexpr std::size_t kMaxItemEvents = 100'000;

  /// \throws RecordingError when the file cannot be opened, its header does not end, or it was
  ///         recorded by a camera that is no DAVIS240 or DAVIS346
  explicit Aedat3Reader(const std::string& path);
  ~Aedat3Reader() override;

  std::string format() const override { return "AEDAT3.1"; }
  const std::vector<RecordedStream>& streams() const override;
  bool next(RecordingItem& item) override;
  const std::vector<RecordingDamage>& damage() const override;
  std::uint64_t position() const override;
  std::uint64_t length() const override;
  std::uint64_t fileSize() const override;
  bool knowsExposures() const override { return true; }

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
