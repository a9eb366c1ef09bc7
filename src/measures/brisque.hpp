/// \file
/// BRISQUE, a no-reference quality score (Mittal et al., TIP 2012), by OpenCV's `quality` module
/// with a trained model. 0 = best, 100 = worst.
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

namespace fast_edi {

/// Where Debian's package opencv-data puts the model.
constexpr char kBrisqueModelFile[] = "/usr/share/opencv4/quality/brisque_model_live.yml";
constexpr char kBrisqueRangeFile[] = "/usr/share/opencv4/quality/brisque_range_live.yml";

class Brisque {
 public:
  /// \throws UnavailableError without OpenCV's quality module
  /// \throws std::runtime_error naming the file that cannot be read
  explicit Brisque(const std::string& model_file = kBrisqueModelFile,
                   const std::string& range_file = kBrisqueRangeFile);
  ~Brisque();
  Brisque(Brisque&&) noexcept;
  Brisque& operator=(Brisque&&) noexcept;

  /// \throws std::invalid_argument unless \p image is CV_8UC1 and not empty
  double score(const cv::Mat& image) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
