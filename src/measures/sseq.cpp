#include "measures/sseq.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#ifdef FAST_EDI_HAVE_LIBSVM
#include <svm.h>
#endif

#include "measures/capability.hpp"

namespace fast_edi {

#ifdef FAST_EDI_HAVE_LIBSVM

namespace {

constexpr std::size_t kClasses = 5;
constexpr double kScoreMiddle = 50.0;  // regressions were trained on scores of 0..100 as -1..1

struct DestroyModel {
  void operator()(svm_model* model) const { svm_free_and_destroy_model(&model); }
};
using Model = std::unique_ptr<svm_model, DestroyModel>;

struct Range {
  double low;
  double high;
};

Model loadModel(const std::string& file) {
  if (!std::ifstream(file)) {
    throw std::runtime_error("SSEQ: cannot read " + file);
  }
  Model model(svm_load_model(file.c_str()));
  if (!model) {
    throw std::runtime_error("SSEQ: " + file + " is not a libsvm model");
  }
  return model;
}

std::array<Range, kSseqFeatures> loadRanges(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) {
    throw std::runtime_error("SSEQ: cannot read " + file);
  }
  std::array<Range, kSseqFeatures> ranges{};
  std::size_t count = 0;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty() || line[0] == '#') {
      continue;
    }
    Range range{};
    std::istringstream fields(line);
    if (!(fields >> range.low >> range.high) || !(range.low < range.high)) {
      throw std::runtime_error("SSEQ: " + file + ":" + std::to_string(number) +
                               ": expected minimum and maximum of a feature, got '" + line + "'");
    }
    if (count == ranges.size()) {
      throw std::runtime_error("SSEQ: " + file + ":" + std::to_string(number) +
                               ": expected the ranges of 12 features, got more");
    }
    ranges[count++] = range;
  }
  if (count != ranges.size()) {
    throw std::runtime_error("SSEQ: " + file + ": expected the ranges of 12 features, got " +
                             std::to_string(count));
  }
  return ranges;
}

}  // namespace

class Sseq::Impl {
 public:
  explicit Impl(const std::string& folder)
      : ranges_(loadRanges(folder + "/feature_range.txt")),
        classifier_(loadModel(folder + "/class.libsvm")) {
    if (svm_get_svm_type(classifier_.get()) != C_SVC ||
        svm_check_probability_model(classifier_.get()) == 0 ||
        svm_get_nr_class(classifier_.get()) != static_cast<int>(kClasses)) {
      throw std::runtime_error("SSEQ: " + folder +
                               "/class.libsvm: expected an SVC of 5 classes with probabilities");
    }
    std::array<int, kClasses> labels{};
    svm_get_labels(classifier_.get(), labels.data());
    for (std::size_t k = 0; k < kClasses; ++k) {
      if (labels[k] < 1 || labels[k] > static_cast<int>(kClasses)) {
        throw std::runtime_error("SSEQ: " + folder + "/class.libsvm: expected labels 1..5, got " +
                                 std::to_string(labels[k]));
      }
      const std::string file = folder + "/regression_" + std::to_string(labels[k]) + ".libsvm";
      regressions_[k] = loadModel(file);
      if (svm_get_svm_type(regressions_[k].get()) != NU_SVR) {
        throw std::runtime_error("SSEQ: " + file + ": expected a nu-SVR");
      }
    }
  }

  double score(const std::array<double, kSseqFeatures>& features) const {
    std::array<svm_node, kSseqFeatures + 1> nodes{};
    for (std::size_t i = 0; i < features.size(); ++i) {
      const Range& range = ranges_[i];
      nodes[i] = {static_cast<int>(i) + 1,
                  2.0 * (features[i] - range.low) / (range.high - range.low) - 1.0};
    }
    nodes.back() = {-1, 0.0};  // libsvm's end mark

    std::array<double, kClasses> probabilities{};
    svm_predict_probability(classifier_.get(), nodes.data(), probabilities.data());
    double sum = 0.0;
    for (std::size_t k = 0; k < kClasses; ++k) {
      sum += probabilities[k] * svm_predict(regressions_[k].get(), nodes.data());
    }
    return kScoreMiddle + kScoreMiddle * sum;
  }

 private:
  std::array<Range, kSseqFeatures> ranges_;
  Model classifier_;
  std::array<Model, kClasses> regressions_;
};

#else

class Sseq::Impl {
 public:
  explicit Impl(const std::string&) {}
  double score(const std::array<double, kSseqFeatures>&) const { return 0.0; }
};

#endif

Sseq::Sseq(const std::string& model_folder) {
  require(OptionalLibrary::kLibsvm, "SSEQ");
  impl_ = std::make_unique<Impl>(model_folder);
}

Sseq::~Sseq() = default;
Sseq::Sseq(Sseq&&) noexcept = default;
Sseq& Sseq::operator=(Sseq&&) noexcept = default;

double Sseq::score(const cv::Mat& image) const {
  return impl_->score(sseqFeatures(image));
}

}  // namespace fast_edi
