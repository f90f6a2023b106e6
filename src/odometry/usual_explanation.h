/// \file usual_explanation.h
/// Whether a map explains as much of a sweep as it usually does.
#pragma once

#include <algorithm>

namespace pcl_floam {

/// A sweep of which the map explains less than half of what it explained of those before may be at a wrong place. How
/// much that is, is the scene's: on an open road half of the points lie on nothing that two rings have seen.
class UsualExplanation {
public:
  /// Of a map that has explained nothing yet: it has to explain half of a sweep.
  [[nodiscard]] static UsualExplanation ofPriorMap()
  {
    UsualExplanation prior;
    prior.usual_ = 1.0;
    return prior;
  }

  /// \param explained part of a sweep's points that lie on surfaces of the map
  [[nodiscard]] bool isMet(double explained) const
  {
    constexpr double kPart = 0.5;  // what comes into view anew is the smaller part of a sweep
    return explained >= kPart * usual_;
  }

  /// Whether the last sweep may enter the map: what came in at a wrong pose would bear that out. After so long there is
  /// no way back; but a map that was made before has to explain one sweep at least.
  [[nodiscard]] bool bearsOut() const { return missed_ == 0 || (taken_ > 0.0 && missed_ > kNoWayBack); }

  void take(double explained)
  {
    missed_ = isMet(explained) ? 0 : missed_ + 1;
    if (missed_ == 0) {
      takeUnjudged(explained);
    }
  }

  /// While it is open how the sensor began to move: motions are judged by others, and each makes its own map.
  void takeUnjudged(double explained)
  {
    constexpr double kRemembered = 10.0;  // sweeps
    taken_ = std::min(taken_ + 1.0, kRemembered);
    usual_ += (explained - usual_) / taken_;
    missed_ = 0;
  }

private:
  /// Sweeps in a row, after which the sensor is taken to be elsewhere, and what it sees there has to come in: longer
  /// than it is covered by a hand, or passes from one room into the next.
  static constexpr int kNoWayBack = 30;

  double usual_ = 0.0;
  double taken_ = 0.0;  ///< sweeps that make it up
  int missed_ = 0;      ///< sweeps in a row
};

}  // namespace pcl_floam
