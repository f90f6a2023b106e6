#include "motion/scan_clock.h"

#include "common/median.h"

#include <cmath>

namespace pcl_floam {

namespace {

constexpr std::size_t kRememberedPeriods = 9;
constexpr double kClockWasSet = 100.0;  // periods
constexpr double kNoTime = 0.01;        // periods; a velocity over less would be the noise of the pose

}  // namespace

double ScanClock::period() const
{
  if (given_period_ > 0.0 || recent_.empty()) {
    return given_period_;
  }
  std::vector<double> recent = recent_;
  return medianOf(recent);
}

double ScanClock::tick(std::optional<double> stamp)
{
  if (!stamp || !std::isfinite(*stamp)) {
    return 1.0;
  }
  if (!last_stamp_) {
    last_stamp_ = stamp;
    return 1.0;
  }
  const double elapsed = *stamp - *last_stamp_;
  const double usual = period();
  last_stamp_ = stamp;
  const bool clock_was_set = !std::isfinite(elapsed) || (usual > 0.0 && std::abs(elapsed) > kClockWasSet * usual);
  if (elapsed > 0.0 && std::isfinite(elapsed)) {
    remember(elapsed);  // in any case: the period may have been taken from stamps that were wrong
  }
  if (!clock_was_set && elapsed <= kNoTime * usual) {
    return 0.0;
  }
  return clock_was_set ? 1.0 : elapsed / period();
}

void ScanClock::remember(double elapsed)
{
  if (recent_.size() == kRememberedPeriods) {
    recent_.erase(recent_.begin());
  }
  recent_.push_back(elapsed);
}

}  // namespace pcl_floam
