/// \file
/// How good the high-rate video is at each instant of an exposure, on simulated sequences, whose
/// truth is known at any time.
///
/// At mid-exposure a latent image is surest: the blurry frame is near to it, and what events say of
/// the way from there adds up its errors towards both ends.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "fast_edi/parameters/parameters.hpp"
#include "sequences/sequences.hpp"

namespace fast_edi {

struct VideoQuality {
  std::string name;
  int frames = 0;               ///< those that were measured
  std::vector<double> psnr_db;  ///< mean over the frames, at (i + 0.5) / n of the exposure
  double largest_loss_db = 0;   ///< of one image against the middle one of the same exposure

  /// Mean PSNR of the middle image less that of the worst instant [dB].
  double lossDb() const;
};

/// \param parameters of the pipeline; thresholds and exposure are those of the simulated sensor
/// \param images within each exposure, odd so that one is the middle, > 0
/// \param skip first frames that are not measured: what comes after learning
/// \param progress called after each frame with the number of frames done
/// \throws std::invalid_argument when \p images is even or not positive
VideoQuality videoQuality(const EvaluationSequence& sequence, const DeblurParameters& parameters,
                          int images, int skip, const std::function<void(int)>& progress);

/// A Markdown table, one row for each sequence and their mean.
void printVideoTable(std::ostream& out, const std::vector<VideoQuality>& sequences);

}  // namespace fast_edi
