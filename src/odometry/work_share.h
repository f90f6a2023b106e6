/// \file work_share.h
/// How much of what a start has to do one sweep bears.
#pragma once

#include <algorithm>
#include <cstddef>

namespace pcl_floam {

/// Work that one sweep bears beside its own registration, counted in usual registrations: counted, not timed, so that
/// results do not depend on the machine.
class WorkShare {
public:
  // What a part of a start costs, with the evidence that rivals are compared by and the maps that are made for it.
  static constexpr double kFollow = 1.5;    ///< one more track takes the sweep
  static constexpr double kLook = 1.5;      ///< thinned sweeps are registered with each other
  static constexpr double kBegin = 4.0;     ///< a track begins with the first two sweeps, in two rounds
  static constexpr double kCatchUp = 2.0;   ///< a track takes a sweep of before
  static constexpr double kBack = 2.0;      ///< a sweep is found once more
  static constexpr double kTurnBack = 5.0;  ///< a map is made of the last sweeps, and its shapes when it is asked
  static constexpr double kInsert = 0.5;    ///< a map takes in a sweep
  /// With less, sweeps would come as fast as a late track takes them.
  static constexpr double kLeast = 2.0 * kCatchUp;

  /// \param registrations that a sweep may bear
  /// \param followed      tracks that took it, one of which is its own
  WorkShare(double registrations, std::size_t followed)
      : left_(std::max(kLeast, registrations - kFollow * (static_cast<double>(followed) - 1.0)))
  {
  }

  /// Whether a part of the work that costs so much is done with this sweep; the first always, however much it is.
  [[nodiscard]] bool take(double cost)
  {
    if (cost > left_ && has_begun_) {
      return false;
    }
    has_begun_ = true;
    left_ -= cost;
    return true;
  }

private:
  double left_;
  bool has_begun_ = false;
};

}  // namespace pcl_floam
