/// \file waiting_scans.h
/// The scans that nothing is known of before the first motion.
#pragma once

#include <vector>

namespace pcl_floam {

/// When there were scans, from the one at the pose that the odometry was given until a motion is known: then it tells
/// where they were. After more than a second (10 periods) that would be too bold a guess, and they stay as they are.
class WaitingScans {
public:
  void elapse(double periods) { now_ += periods; }

  /// The present scan is not registered.
  void add()
  {
    if (isShort()) {
      others_.push_back(now_);
    }
  }

  /// The present scan takes the first one's part, and is not yet known where it is.
  void beginWithLast()
  {
    add();
    first_ = now_;
  }

  /// Periods from the given pose to the scan that the map begins with.
  [[nodiscard]] double first() const { return isShort() ? first_ : 0.0; }

  /// Periods from the given pose to all others.
  [[nodiscard]] std::vector<double> others() const { return isShort() ? others_ : std::vector<double>(); }

private:
  [[nodiscard]] bool isShort() const { return now_ <= 10.0; }

  double now_ = 0.0;
  double first_ = 0.0;
  std::vector<double> others_;
};

}  // namespace pcl_floam
