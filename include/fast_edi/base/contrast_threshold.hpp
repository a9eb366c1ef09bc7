/// \file
/// The pair of contrast thresholds of a sensor.
#pragma once

namespace fast_edi {

/// Contrast thresholds in natural-log units, both positive: an ON event says that log intensity has
/// risen by `on`, an OFF event that it has fallen by `off`. This header is the one place where the
/// sign is applied.
struct ContrastThresholds {
  double on = 0.0;
  double off = 0.0;

  /// Change of log intensity that an event of the given polarity stands for [natural log].
  double step(bool polarity_on) const { return polarity_on ? on : -off; }

  friend bool operator==(const ContrastThresholds& a, const ContrastThresholds& b) {
    return a.on == b.on && a.off == b.off;
  }
  friend bool operator!=(const ContrastThresholds& a, const ContrastThresholds& b) {
    return !(a == b);
  }
};

}  // namespace fast_edi
