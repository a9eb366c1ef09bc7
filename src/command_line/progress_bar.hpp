/// \file
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace fast_edi {

/// A bar on standard error, if that is a terminal; nothing at all otherwise.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  /// Ends the line.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Cheap enough to be called for each message: draws ten times a second at most.
  void update(std::uint64_t done, std::uint64_t total);

 private:
  void draw(double fraction);

  const std::string label_;
  const bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point next_draw_;
};

}  // namespace fast_edi
