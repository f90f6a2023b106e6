/// \file first_motion.h
/// How the sensor may have moved between the first two sweeps.
#pragma once

#include "odometry/track.h"

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// m a period: 40 m/s at ten sweeps a second.
inline constexpr double kFastestMotion = 4.0;

/// Whether one of some velocities is the same as another.
[[nodiscard]] bool isAmong(const std::vector<Vector6>& velocities, const Vector6& velocity, double same);

/// Looks for motions that registrations of two thinned sweeps lead to: from rest and as it is told, and then along the
/// direction that this leaves open, a few at a time, since together they take as long as many scans.
class FirstMotionSearch {
public:
  /// Looks from rest, and as it is told.
  FirstMotionSearch(const Sweep& first, const Sweep& second, const TrackSettings& settings);

  /// Whether nothing is left to look at.
  [[nodiscard]] bool isDone() const { return left() == 0; }
  /// Looks that are left.
  [[nodiscard]] std::size_t left() const { return looks_.size() - looked_; }
  /// Looks at the next few, at most those that are left.
  void goOn(std::size_t looks);
  /// Velocities per period, the likeliest of those found so far first; none if the sweeps do not fit at all.
  [[nodiscard]] std::vector<Vector6> likelyMotions() const;
  /// m a period, within which two motions are one: a registration finds either from the other.
  [[nodiscard]] double same() const;

private:
  struct Found {
    Vector6 velocity;
    double evidence = 0.0;
  };

  std::vector<RegistrationReport> lookAt(const std::vector<FirstLook>& looks);

  std::vector<Track> tracks_;     // one a thread
  Sweep first_, second_;          // thinned
  std::vector<FirstLook> looks_;  // along what is open
  std::size_t looked_ = 0;
  std::vector<Found> found_;
};

}  // namespace pcl_floam
