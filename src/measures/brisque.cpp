#include "measures/brisque.hpp"

#include <fstream>
#include <stdexcept>

#ifdef FAST_EDI_HAVE_OPENCV_QUALITY
#include <opencv2/quality/qualitybrisque.hpp>
#endif

#include "measures/capability.hpp"
#include "measures/image_metrics.hpp"

namespace fast_edi {

#ifdef FAST_EDI_HAVE_OPENCV_QUALITY

class Brisque::Impl {
 public:
  Impl(const std::string& model_file, const std::string& range_file)
      : quality_(cv::quality::QualityBRISQUE::create(model_file, range_file)) {}

  double score(const cv::Mat& image) { return quality_->compute(image)[0]; }

 private:
  cv::Ptr<cv::quality::QualityBRISQUE> quality_;
};

#else

class Brisque::Impl {
 public:
  Impl(const std::string&, const std::string&) {}
  double score(const cv::Mat&) { return 0.0; }
};

#endif

Brisque::Brisque(const std::string& model_file, const std::string& range_file) {
  require(OptionalLibrary::kOpencvQuality, "BRISQUE");
  for (const std::string& file : {model_file, range_file}) {
    if (!std::ifstream(file)) {
      throw std::runtime_error("BRISQUE: cannot read " + file +
                               " (Debian's package opencv-data has the model and range files)");
    }
  }
  try {
    impl_ = std::make_unique<Impl>(model_file, range_file);
  } catch (const cv::Exception& error) {
    throw std::runtime_error("BRISQUE: " + model_file + " and " + range_file +
                             " are not a model and its ranges: " + error.what());
  }
}

Brisque::~Brisque() = default;
Brisque::Brisque(Brisque&&) noexcept = default;
Brisque& Brisque::operator=(Brisque&&) noexcept = default;

double Brisque::score(const cv::Mat& image) const {
  requireMono8(image, "BRISQUE");
  return impl_->score(image);
}

}  // namespace fast_edi
