/// \file scan_clock.h
/// How far apart scans are, from their stamps.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace pcl_floam {

/// How far apart scans are, in periods of the sensor: 1 from one scan to the next, 2 when one is missing.
class ScanClock {
public:
  /// \param period s; 0 to take it from the stamps
  explicit ScanClock(double period = 0.0) : given_period_(period) {}

  /// Periods since the last scan: 1 without a stamp, which the next stamp does not count again; 0 for a stamp that does
  /// not advance, but as without one for those that follow and do not either, or if none ever did. A hundred and more,
  /// forwards or back, mean that the clock was set: that is 1, too.
  double tick(std::optional<double> stamp);

  /// How far off that may be, one standard deviation: a stamp that does not advance may be an old scan's or none at
  /// all.
  [[nodiscard]] double error() const;
  /// How far off the periods between any two scans may be, since stamps that are taken when a scan arrives jitter.
  [[nodiscard]] double jitter() const;

  /// Seconds from sweep to sweep; 0 while unknown.
  [[nodiscard]] double period() const;

private:
  double given_period_;
  std::optional<double> last_stamp_;
  int standing_ = 0;        ///< the last stamps that did not advance
  bool stood_ = false;      ///< the one before the last did not
  double unstamped_ = 0.0;  ///< periods counted since the last stamp

  static constexpr std::size_t kRemembered = 31;  ///< a few seconds: longer than a disturbance
  std::array<double, kRemembered> recent_{};      ///< the last differences of stamps, s a period
  std::size_t remembered_ = 0;
};

}  // namespace pcl_floam
