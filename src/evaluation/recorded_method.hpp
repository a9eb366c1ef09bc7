/// \file
/// A method that ran elsewhere: its frames come from a recording.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "evaluation/frames_by_stamp.hpp"
#include "evaluation/other_method.hpp"

namespace fast_edi {

/// Frames are matched within 1 us by the stamp of the latent image or, failing that, by that of the
/// input frame: many programs keep it, whatever instant they show.
class RecordedMethod : public OtherMethod {
 public:
  /// \param source for messages: "out.bag /dvs/deblurred/image_raw"
  /// \param frames empty images: an encoding that is not deblurred
  RecordedMethod(std::string name, std::string source, FramesByStamp frames);

  std::string name() const override { return name_; }
  /// \throws std::runtime_error for a frame of another size than the input's, or of an encoding
  /// that is not known
  Result deblur(const Frame& frame) override;
  /// The stamps of frames that are missing, and how many recorded frames belong to none.
  std::vector<std::string> notes() const override;

 private:
  std::string name_;
  std::string source_;
  FramesByStamp frames_;
  std::set<std::int64_t> used_;
  std::vector<std::int64_t> missing_;
};

}  // namespace fast_edi
