#include "pipeline/window_integral.hpp"

#include <cstdlib>

namespace fast_edi {
namespace {

/// Running sums of a window this close to the true one are still of use to DoubleIntegral.
constexpr std::int64_t kUsefulPrediction_ns = 50 * kNanosecondsPerMicrosecond;

bool isNear(std::int64_t a_ns, std::int64_t b_ns) {
  return std::abs(a_ns - b_ns) <= kUsefulPrediction_ns;
}

}  // namespace

bool WindowIntegral::areNear(const Prediction& a, const Prediction& b) {
  return isNear(a.window.start_ns, b.window.start_ns) && isNear(a.window.end_ns, b.window.end_ns) &&
         isNear(a.reference_ns, b.reference_ns);
}

WindowIntegral::Counting WindowIntegral::countingFor(const DeblurParameters& parameters) {
  if (!parameters.filter.enabled) {
    return Counting::kNone;
  }
  return parameters.filter.reblur && parameters.reference == ExposureInstant::kMid
             ? Counting::kQuarters
             : Counting::kWindow;
}

bool WindowIntegral::prepare(EventStream& events, const DeblurParameters& parameters,
                             bool may_allocate) {
  if (!integral_ || size_ != events.lists()->size()) {
    if (!may_allocate) {
      return false;
    }
    integral_.reset();  // before the new one, so that both are never held at once
    size_ = events.lists()->size();
    integral_ = std::make_unique<DoubleIntegral>(size_, parameters.thresholds, parameters.weighting,
                                                 levelModel(parameters));
    gains_.resize(size_.pixelCount());
    counts_.emplace(size_);
    quarters_.reset();
    predicted_.reset();
  }
  events.keepIntervals(!integral_->level().isStaircase());
  if (generation_ != events.generation()) {
    integral_->reset();
    counts_->reset();
    quarters_.reset();
    generation_ = events.generation();
    predicted_.reset();
  }
  return true;
}

void WindowIntegral::adopt(const DeblurParameters& parameters) {
  if (integral_ && (integral_->weighting() != parameters.weighting ||
                    integral_->level() != levelModel(parameters))) {
    integral_.reset();
    predicted_.reset();
  }
  if (integral_ && integral_->thresholds() != parameters.thresholds) {
    integral_->setThresholds(parameters.thresholds);
    predicted_.reset();
  }
}

void WindowIntegral::predictWindow(const ExposureInterval& window, std::int64_t reference_ns) {
  const Prediction prediction{window, reference_ns};
  if (!predicted_ || !areNear(*predicted_, prediction)) {
    integral_->predictWindow(window, reference_ns);
    predicted_ = prediction;
  }
}

void WindowIntegral::wantQuarters(Counting counting) {
  if (counting != Counting::kQuarters) {
    quarters_.reset();
  } else if (!quarters_) {
    quarters_.emplace(size_);
  }
}

void WindowIntegral::accumulate(const PixelEventLists& lists, Counting counting) {
  integral_->accumulate(lists);
  wantQuarters(counting);
  if (counting != Counting::kNone && predicted_) {
    counts_->accumulate(lists, predicted_->window);
    if (quarters_) {
      quarters_->accumulate(lists, predicted_->window);
    }
  }
}

IntegrationReport WindowIntegral::integrate(const PixelEventLists& lists,
                                            const ExposureInterval& window,
                                            std::int64_t reference_ns, Counting counting) {
  const IntegrationReport report = integral_->integrate(lists, window, reference_ns, gains_.data());
  predicted_.reset();
  wantQuarters(counting);
  if (counting != Counting::kNone) {
    counts_->count(lists, window);
    if (quarters_) {
      quarters_->count(lists, window);
    }
  }
  return report;
}

std::size_t WindowIntegral::memoryBytes() const {
  return gains_.capacity() * sizeof(float) + (integral_ ? integral_->memoryBytes() : 0) +
         (counts_ ? counts_->memoryBytes() : 0) + (quarters_ ? quarters_->memoryBytes() : 0);
}

}  // namespace fast_edi
