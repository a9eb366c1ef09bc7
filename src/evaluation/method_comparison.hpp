/// \file
/// One recording through all methods that are compared, frame by frame.
///
/// Everything that goes in reaches one Deblurrer for each variant of EDI and the contrast search,
/// so that all methods see the same events, exposures and decisions about frames.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include <opencv2/core.hpp>

#include "evaluation/contrast_search.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace fast_edi {

/// What is compared, in the order of reports.
enum class Method {
  kBlurry,    ///< the input frame
  kPlain,     ///< EDI, weighted by elapsed time, nothing else
  kCounter,   ///< EDI, weighted by the event counter (Lin et al., ICRA 2023)
  kSearched,  ///< plain EDI, one contrast for both polarities found for each frame (Pan et al.)
  kOurs,      ///< this package as its parameters are
  kTruth,     ///< the true sharp frame, where there is one: what a perfect method would score
};
constexpr std::size_t kMethodCount = 6;
constexpr std::array<Method, kMethodCount> kAllMethods = {Method::kBlurry,  Method::kPlain,
                                                          Method::kCounter, Method::kSearched,
                                                          Method::kOurs,    Method::kTruth};
constexpr std::size_t indexOf(Method method) {
  return static_cast<std::size_t>(method);
}
/// For tables: "plain EDI".
const char* toString(Method method);

/// The parameters that a method's Deblurrer runs with. \pre kPlain, kCounter or kOurs
/// \param ours the parameters under evaluation
DeblurParameters parametersOf(Method method, const DeblurParameters& ours);

struct ComparedFrame {
  std::int64_t stamp_ns = 0;        ///< of the output: the instant that the latent images show
  std::int64_t input_stamp_ns = 0;  ///< of the input frame
  bool compared = false;            ///< false: passed through, or its events are no longer there
  PassReason pass_reason = PassReason::kPassthroughParameter;  ///< when passed through
  ExposureInterval exposure;                                   ///< in frame time
  std::uint64_t events = 0;                                    ///< inside the exposure
  std::array<cv::Mat, kMethodCount> images;  ///< CV_8UC1; kTruth empty; only when compared
  /// Wall clock: taking in events since the frame before, and closing [ms]. 0 for kBlurry, kTruth.
  std::array<double, kMethodCount> runtime_ms{};
  double searched_contrast = 0.0;  ///< [natural log]
};

class MethodComparison {
 public:
  using Sink = std::function<void(const ComparedFrame&)>;

  /// \param parameters all methods show their `reference`, the instant at which truth is wanted
  /// \throws std::invalid_argument naming the parameter that is out of range
  MethodComparison(const DeblurParameters& parameters, const ContrastSearchOptions& search,
                   Sink sink);
  ~MethodComparison();
  MethodComparison(const MethodComparison&) = delete;
  MethodComparison& operator=(const MethodComparison&) = delete;

  /// See Deblurrer for these. The sink is called from within them and may throw.
  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                 std::int64_t now_ns);
  /// \param image CV_8UC1; empty: an encoding that is not deblurred
  void addFrame(std::int64_t stamp_ns, const cv::Mat& image, std::int64_t now_ns);
  void addExposure(std::int32_t exposure_us, std::int64_t now_ns);
  void advance(std::int64_t now_ns);
  void finish();

  /// Of the variant under evaluation.
  const DeblurCounters& counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
