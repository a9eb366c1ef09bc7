#include "evaluation/method_comparison.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <stdexcept>
#include <utility>
#include <vector>

#include "evaluation/pipeline.hpp"
#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/integral/double_integral.hpp"
#include "measures/image_metrics.hpp"

namespace fast_edi {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kDecaysPerExposure = 10;  // of the event map, see eventEdgeMap()

constexpr std::array<Method, 3> kPipelines = {Method::kPlain, Method::kCounter, Method::kOurs};

/// EDI with the contrast found by sharpness, for windows that some other method has found out.
class SearchingEdi {
 public:
  SearchingEdi(const DeblurParameters& parameters, const ContrastSearchOptions& options)
      : parameters_(parameters),
        options_(options),
        stream_({parameters.max_buffered_events, parameters.max_backward_jump_ns,
                 parameters.max_forward_jump_ns},
                counters_, [](StreamReset, std::int64_t) {}) {}

  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence) {
    const auto start = Clock::now();
    const EventMapping& mapping = parameters_.event_mapping;
    mapped_.assign(events.data, events.data + events.count * kWireEventBytes);
    mapping.apply(mapped_.data(), events.count, size);
    stream_.take({mapped_.data(), events.count}, mapping.apply(size), sequence);
    spent_ms_ += millisecondsSince(start);
  }

  struct Result {
    cv::Mat image;
    double contrast = 0.0;
    double runtime_ms = 0.0;
  };

  /// \return an empty image when events of the window are missing
  Result deblur(const cv::Mat& blurry, const ExposureInterval& exposure) {
    const auto start = Clock::now();
    const ExposureInterval window = {exposure.start_ns + parameters_.time_offset_ns,
                                     exposure.end_ns + parameters_.time_offset_ns};
    const SensorSize size = {blurry.cols, blurry.rows};
    Result result;
    if (!stream_.seen() || stream_.lists()->size() != size || !stream_.covers(window)) {
      return result;
    }
    const std::int64_t reference_ns = window.at(parameters_.reference);
    const cv::Mat1f edges =
        eventEdgeMap(eventsIn(window), size, reference_ns,
                     std::max<std::int64_t>(1, window.length() / kDecaysPerExposure));
    std::vector<float> gain(size.pixelCount());
    const auto latent = [&](double contrast) {
      DoubleIntegral integral(size, {contrast, contrast}, Weighting::kTime);
      integral.integrate(*stream_.lists(), window, reference_ns, gain.data());
      cv::Mat image(blurry.size(), CV_8UC1);
      parameters_.response.applyGain(viewOf(blurry), gain.data(), mutableViewOf(image));
      return image;
    };
    const SharpnessEnergy energy(blurry, edges, options_.lambda);
    result.contrast = searchContrast(latent, energy, options_).contrast;
    result.image = latent(result.contrast);
    stream_.discardBefore(window.start_ns);
    result.runtime_ms = spent_ms_ + millisecondsSince(start);
    spent_ms_ = 0.0;
    return result;
  }

 private:
  std::vector<Event> eventsIn(const ExposureInterval& window) const {
    const PixelEventLists& lists = *stream_.lists();
    const auto width = static_cast<std::uint32_t>(lists.size().width);
    const std::uint64_t end = lists.lowerBound(window.end_ns);
    std::vector<Event> events;
    for (std::uint64_t at = lists.lowerBound(window.start_ns); at < end;) {
      const PackedEventSpan span = lists.span(at, end);
      for (std::size_t i = 0; i < span.count; ++i) {
        const std::uint32_t pixel = span.data[i].code / 2;
        events.push_back({static_cast<std::uint16_t>(pixel % width),
                          static_cast<std::uint16_t>(pixel / width),
                          span.base_ns + span.data[i].dt_ns, span.data[i].code % 2 == 1});
      }
      at += span.count;
    }
    return events;
  }

  DeblurParameters parameters_;
  ContrastSearchOptions options_;
  DeblurCounters counters_;
  std::vector<std::uint8_t> mapped_;  ///< the last array of events
  EventStream stream_;
  double spent_ms_ = 0.0;
};

}  // namespace

const char* toString(Method method) {
  switch (method) {
    case Method::kBlurry:
      return "blurry input";
    case Method::kPlain:
      return "plain EDI";
    case Method::kCounter:
      return "counter EDI";
    case Method::kSearched:
      return "searched contrast";
    case Method::kOurs:
      return "ours";
    case Method::kTruth:
      return "truth";
  }
  return "unknown";
}

DeblurParameters parametersOf(Method method, const DeblurParameters& ours) {
  DeblurParameters parameters = ours;
  parameters.filter.enabled = parameters.filter.enabled && method == Method::kOurs;
  if (method != Method::kOurs) {
    parameters.filter.enabled = false;
    parameters.weighting = method == Method::kCounter ? Weighting::kCounter : Weighting::kTime;
  }
  return parameters;
}

class MethodComparison::Impl {
 public:
  Impl(const DeblurParameters& parameters, const ContrastSearchOptions& search, Sink sink)
      : searching_(parametersOf(Method::kPlain, parameters), search), sink_(std::move(sink)) {
    for (std::size_t i = 0; i < kPipelines.size(); ++i) {
      pipelines_[i] = std::make_unique<Pipeline>(parametersOf(kPipelines[i], parameters));
    }
  }

  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                 std::int64_t now_ns) {
    searching_.addEvents(events, size, sequence);
    runAll([&](Deblurrer& deblurrer) { deblurrer.addEvents(events, size, sequence, now_ns); });
  }

  void addFrame(std::int64_t stamp_ns, const cv::Mat& image, std::int64_t now_ns) {
    if (!image.empty()) {
      requireMono8(image, "frame");
    }
    const InputFrame frame = inputFrame(stamp_ns, image);
    runAll([&](Deblurrer& deblurrer) { deblurrer.addFrame(frame, now_ns); });
  }

  template <typename Call>
  void runAll(Call call) {
    for (const auto& pipeline : pipelines_) {
      pipeline->run(call);
    }
    emit();
  }

  const DeblurCounters& counters() const { return pipelines_.back()->counters(); }

 private:
  bool allFinished() const {
    for (const auto& pipeline : pipelines_) {
      if (!pipeline->hasFinished()) {
        return false;
      }
    }
    return true;
  }

  void emit() {
    while (allFinished()) {
      ComparedFrame frame;
      for (std::size_t i = 0; i < kPipelines.size(); ++i) {
        Pipeline::Finished finished = pipelines_[i]->take();
        const OutputFrame& output = finished.output;
        if (i == 0) {
          frame.stamp_ns = output.stamp_ns;
          frame.input_stamp_ns = output.input.stamp_ns;
          frame.compared = output.deblurred;
          frame.pass_reason = output.pass_reason;
          frame.exposure = output.exposure;
          frame.events = output.events;
          if (output.input.owner) {
            frame.images[indexOf(Method::kBlurry)] =
                *std::static_pointer_cast<const cv::Mat>(output.input.owner);
          }
        } else if (output.stamp_ns != frame.stamp_ns) {
          throw std::logic_error("methods disagree about the next output frame");
        }
        frame.images[indexOf(kPipelines[i])] = finished.image;
        frame.runtime_ms[indexOf(kPipelines[i])] = finished.runtime_ms;
      }
      if (frame.compared) {
        addSearched(frame);
      }
      sink_(frame);
    }
  }

  void addSearched(ComparedFrame& frame) {
    const std::size_t searched = indexOf(Method::kSearched);
    SearchingEdi::Result result =
        searching_.deblur(frame.images[indexOf(Method::kBlurry)], frame.exposure);
    if (result.image.empty()) {
      frame.compared = false;
      frame.pass_reason = PassReason::kEventsMissing;
      return;
    }
    frame.images[searched] = result.image;
    frame.runtime_ms[searched] = result.runtime_ms;
    frame.searched_contrast = result.contrast;
  }

  std::array<std::unique_ptr<Pipeline>, kPipelines.size()> pipelines_;
  SearchingEdi searching_;
  Sink sink_;
};

MethodComparison::MethodComparison(const DeblurParameters& parameters,
                                   const ContrastSearchOptions& search, Sink sink)
    : impl_(std::make_unique<Impl>(parameters, search, std::move(sink))) {}
MethodComparison::~MethodComparison() = default;

void MethodComparison::addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                                 std::int64_t now_ns) {
  impl_->addEvents(events, size, sequence, now_ns);
}

void MethodComparison::addFrame(std::int64_t stamp_ns, const cv::Mat& image, std::int64_t now_ns) {
  impl_->addFrame(stamp_ns, image, now_ns);
}

void MethodComparison::addExposure(std::int32_t exposure_us, std::int64_t now_ns) {
  impl_->runAll([&](Deblurrer& deblurrer) { deblurrer.addExposure(exposure_us, now_ns); });
}

void MethodComparison::advance(std::int64_t now_ns) {
  impl_->runAll([&](Deblurrer& deblurrer) { deblurrer.advance(now_ns); });
}

void MethodComparison::finish() {
  impl_->runAll([](Deblurrer& deblurrer) { deblurrer.finish(); });
}

const DeblurCounters& MethodComparison::counters() const {
  return impl_->counters();
}

}  // namespace fast_edi
