/// \file
/// Frames chosen by their numbers.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fast_edi {

/// All frames, or those of some ranges of numbers.
class FrameChoice {
 public:
  FrameChoice() = default;  ///< all
  /// \param text numbers from 1 on and ranges of them: "3-5,9"
  /// \throws std::invalid_argument saying what was expected
  explicit FrameChoice(const std::string& text);

  /// \param number of a frame, from 1 on
  bool contains(int number) const;

 private:
  std::vector<std::pair<int, int>> ranges_;  ///< first and last one; none: all
};

}  // namespace fast_edi
