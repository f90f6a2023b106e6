#include "motion/scan_clock.h"

#include "common/median.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

namespace {

constexpr double kClockWasSet = 100.0;  // periods
constexpr double kNoTime = 0.01;        // periods; a velocity over less would be the noise of the pose

}  // namespace

double ScanClock::period() const
{
  if (given_period_ > 0.0) {
    return given_period_;
  }
  std::array<double, kRemembered> recent = recent_;
  return medianOf(recent.begin(), recent.begin() + std::min(remembered_, kRemembered));
}

/// By the median of what differences are off a whole number of periods.
double ScanClock::jitter() const
{
  constexpr double kPerDeviation = 1.4826;  // standard deviations per median of absolute deviations
  constexpr std::size_t kFewest = 5;        // differences: one that is odd must not decide
  const double usual = period();
  if (remembered_ < kFewest || !(usual > 0.0)) {
    return 0.0;
  }
  std::array<double, kRemembered> off = recent_;
  const auto end = off.begin() + std::min(remembered_, kRemembered);
  std::for_each(off.begin(), end, [usual](double& elapsed) {
    const double periods = elapsed / usual;
    elapsed = std::abs(periods - std::max(1.0, std::round(periods)));
  });
  return kPerDeviation * medianOf(off.begin(), end);
}

double ScanClock::error() const
{
  return std::sqrt(static_cast<double>(standing_ == 1) + static_cast<double>(stood_));
}

double ScanClock::tick(std::optional<double> stamp)
{
  const int stood = std::exchange(standing_, 0);
  stood_ = stood == 1;
  if (!stamp || !std::isfinite(*stamp)) {
    unstamped_ += 1.0;
    return 1.0;
  }
  const double counted = std::exchange(unstamped_, 0.0);
  if (!last_stamp_) {
    last_stamp_ = stamp;
    return 1.0;
  }
  const double elapsed = *stamp - *last_stamp_;
  const double usual = period();
  last_stamp_ = stamp;
  const bool clock_was_set = !std::isfinite(elapsed) || (usual > 0.0 && std::abs(elapsed) > kClockWasSet * usual);
  if (elapsed > 0.0 && std::isfinite(elapsed)) {
    // In any case: the period may have been taken from stamps that were wrong.
    recent_[remembered_++ % kRemembered] = elapsed / (1.0 + counted);
  }
  if (!clock_was_set && elapsed <= kNoTime * usual) {
    standing_ = usual > 0.0 ? stood + 1 : 2;
    if (standing_ == 1) {
      return 0.0;
    }
    unstamped_ = elapsed < 0.0 ? 0.0 : counted + 1.0;
    return 1.0;
  }
  return clock_was_set ? 1.0 : std::max(0.0, elapsed / period() - counted);
}

}  // namespace pcl_floam
