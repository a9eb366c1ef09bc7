/// \file
/// What the benchmarks compare, behind one interface: wire events in, 8-bit images out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"

namespace fast_edi::benchmarks {

/// How the exposures of a run lie; decides what can be known of them beforehand.
enum class Exposures {
  kPeriodic,      ///< as predicted
  kJittering,     ///< a few us off: the prediction has to be corrected
  kNotPredicted,  ///< some ms off: the prediction is of no use
};
const char* toString(Exposures exposures);

struct Memory {
  std::size_t bytes = 0;            ///< of events and per-pixel state
  std::size_t buffered_events = 0;  ///< 0 where that is not counted
};

class Contender {
 public:
  virtual ~Contender() = default;
  /// Called before the exposure begins; what has to know the window beforehand uses it.
  virtual void begin(const ExposureInterval& exposure) = 0;
  virtual void add(const WireEvents& events) = 0;
  /// Writes the latent image at mid-exposure.
  virtual void close(const ExposureInterval& exposure, const std::uint8_t* blurry,
                     std::uint8_t* latent) = 0;
  virtual Memory memory() const = 0;
  /// Empty, or what went wrong: a measurement of something else than it says is worth nothing.
  virtual std::string fault(Exposures exposures) const = 0;
};

enum class Method {
  kOurs,          ///< the whole pipeline (Deblurrer), time weighting, plain EDI
  kOursFiltered,  ///< the same with the default filters
  kOursReblur,    ///< and with filter_reblur
  kPaper,         ///< std::vector per pixel of <t, exp value, counter>
  kVanilla,       ///< the whole image added at every event
};
const char* toString(Method method);

constexpr ContrastThresholds kUsualThresholds{0.3, 0.3};

std::unique_ptr<Contender> makeContender(Method method, SensorSize size,
                                         ContrastThresholds thresholds = kUsualThresholds);

}  // namespace fast_edi::benchmarks
