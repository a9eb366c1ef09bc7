/// \file
/// AEDAT4, the format of iniVation's DV
/// (https://docs.inivation.com/software/software-advanced-usage/file-formats/aedat-4.0.html).
///
/// Packets are read in the order of the file, which is that of their arrival where DV recorded
/// them. Only where the file's data table shows that all frames lie behind all events, as scripts
/// write them, packets are merged by time. A file without a data table (a recording that was
/// interrupted) is read as far as its packets go.
///
/// After damage reading goes on at the next bytes that look like a packet. Of a packet of events
/// that is cut, the events that are there are used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

class Aedat4Reader : public Recording {
 public:
  /// First bytes of such a file.
  static constexpr char kMagic[] = "#!AER-DAT4.0\r\n";
  /// Decompressed packets are no larger [bytes].
  static constexpr std::size_t kMaxPacketBytes = std::size_t{128} << 20;
  /// \throws RecordingError when the file cannot be opened, or its header does not tell how it is
  ///         to be read
  explicit Aedat4Reader(const std::string& path);
  ~Aedat4Reader() override;

  std::string format() const override;
  const std::vector<RecordedStream>& streams() const override;
  bool next(RecordingItem& item) override;
  const std::vector<RecordingDamage>& damage() const override;
  std::uint64_t position() const override;
  std::uint64_t length() const override;
  std::uint64_t fileSize() const override;
  bool knowsExposures() const override { return true; }
  std::optional<BiasConfiguration> biases() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
