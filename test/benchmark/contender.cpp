#include "contender.hpp"

#include <stdexcept>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/paper_lists.hpp"
#include "support/vanilla_edi.hpp"

namespace fast_edi::benchmarks {

namespace {

/// More than any benchmark buffers, so that none of them measures an overflow.
constexpr std::size_t kMaxBufferedEvents = 40'000'000;

/// Writes into memory that the caller of close() names.
class MemorySink : public FrameSink {
 public:
  MutableImageView begin(const InputFrame& input) override {
    return {latent, input.image.size, input.image.step, input.image.format};
  }
  void finish(const OutputFrame&) override { ++finished; }

  std::uint8_t* latent = nullptr;
  std::uint64_t finished = 0;
};

class Ours : public Contender {
 public:
  Ours(SensorSize size, ContrastThresholds thresholds, Method method)
      : size_(size), deblurrer_(parameters(thresholds, method), sink_) {}

  void begin(const ExposureInterval&) override {}
  void add(const WireEvents& events) override {
    deblurrer_.addEvents(events, size_, ++sequence_, ++clock_ns_);
  }
  void close(const ExposureInterval& exposure, const std::uint8_t* blurry,
             std::uint8_t* latent) override {
    sink_.latent = latent;
    ++frames_;
    InputFrame frame;
    frame.stamp_ns = exposure.at(ExposureInstant::kMid);
    frame.image = {blurry, size_, static_cast<std::size_t>(size_.width), PixelFormat::kMono8};
    deblurrer_.addFrame(std::move(frame), ++clock_ns_);
    deblurrer_.addExposure(
        static_cast<std::int32_t>(exposure.length() / kNanosecondsPerMicrosecond), ++clock_ns_);
    if (sink_.finished != frames_) {
      // A scene without an event after this exposure: what has come has to do.
      deblurrer_.advance(clock_ns_ += DeblurParameters{}.close_timeout_ns);
    }
    if (sink_.finished != frames_) throw std::logic_error("the frame was not closed at once");
  }
  Memory memory() const override {
    const DeblurStatus status = deblurrer_.status();
    return {status.buffer_bytes, status.buffered_events};
  }
  std::string fault(Exposures exposures) const override {
    const DeblurCounters& counters = deblurrer_.counters();
    if (counters.frames_deblurred != frames_) return "a frame was passed through";
    const std::uint64_t kind = exposures == Exposures::kNotPredicted
                                   ? counters.windows_not_predicted
                                   : counters.windows_predicted;
    // The first two frames cannot be predicted; a few more may lie across a quantum of time.
    constexpr std::uint64_t kLearning = 2;
    if (10 * kind < 8 * (frames_ - kLearning)) {
      return std::to_string(counters.windows_predicted) + " windows predicted, " +
             std::to_string(counters.windows_not_predicted) + " not predicted, expected mostly " +
             (exposures == Exposures::kNotPredicted ? "the latter" : "the former");
    }
    return {};
  }

 private:
  static DeblurParameters parameters(ContrastThresholds thresholds, Method method) {
    DeblurParameters parameters;
    parameters.thresholds = thresholds;
    parameters.max_buffered_events = kMaxBufferedEvents;
    parameters.filter.enabled = method != Method::kOurs;
    parameters.filter.reblur = method == Method::kOursReblur;
    return parameters;
  }

  SensorSize size_;
  MemorySink sink_;
  Deblurrer deblurrer_;
  std::uint32_t sequence_ = 0;
  std::int64_t clock_ns_ = 0;
  std::uint64_t frames_ = 0;
};

class Paper : public Contender {
 public:
  Paper(SensorSize size, ContrastThresholds thresholds)
      : lists_(size, thresholds, Weighting::kCounter) {}

  void begin(const ExposureInterval&) override {}
  void add(const WireEvents& events) override { lists_.add(events); }
  void close(const ExposureInterval& exposure, const std::uint8_t* blurry,
             std::uint8_t* latent) override {
    lists_.close(exposure, exposure.at(ExposureInstant::kMid), blurry, latent);
  }
  Memory memory() const override { return {lists_.memoryBytes(), 0}; }
  std::string fault(Exposures) const override { return {}; }

 private:
  testing::PaperLists lists_;
};

class Vanilla : public Contender {
 public:
  Vanilla(SensorSize size, ContrastThresholds thresholds) : edi_(size, thresholds) {}

  void begin(const ExposureInterval& exposure) override {
    edi_.begin(exposure, exposure.at(ExposureInstant::kMid));
  }
  void add(const WireEvents& events) override { edi_.add(events); }
  void close(const ExposureInterval&, const std::uint8_t* blurry, std::uint8_t* latent) override {
    edi_.writeImage(blurry, latent);
  }
  Memory memory() const override { return {edi_.memoryBytes(), 0}; }
  std::string fault(Exposures) const override { return {}; }

 private:
  testing::VanillaEdi edi_;
};

}  // namespace

const char* toString(Exposures exposures) {
  switch (exposures) {
    case Exposures::kPeriodic:
      return "periodic";
    case Exposures::kJittering:
      return "jittering";
    case Exposures::kNotPredicted:
      return "unpredicted";
  }
  return "unknown";
}

const char* toString(Method method) {
  switch (method) {
    case Method::kOurs:
      return "ours";
    case Method::kOursFiltered:
      return "ours_filtered";
    case Method::kOursReblur:
      return "ours_reblur";
    case Method::kPaper:
      return "paper";
    case Method::kVanilla:
      return "vanilla";
  }
  return "unknown";
}

std::unique_ptr<Contender> makeContender(Method method, SensorSize size,
                                         ContrastThresholds thresholds) {
  switch (method) {
    case Method::kOurs:
    case Method::kOursFiltered:
    case Method::kOursReblur:
      return std::make_unique<Ours>(size, thresholds, method);
    case Method::kPaper:
      return std::make_unique<Paper>(size, thresholds);
    case Method::kVanilla:
      return std::make_unique<Vanilla>(size, thresholds);
  }
  throw std::invalid_argument("no such method");
}

}  // namespace fast_edi::benchmarks
