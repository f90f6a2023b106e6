/// \file sweep_turn.h
/// How the sensor turns during a sweep, from more than that sweep.
#pragma once

#include <pcl_floam/filters/sweep_motion.h>

#include <optional>

namespace pcl_floam {

/// The rotation during a sweep from what four measurements say of it: this sweep's and the last one's own registration,
/// the rotation between their poses, and that between the poses before.
///
/// In simulated worlds a sweep's rotation is registered with errors of 12 to 146 millidegrees about an axis, that
/// between two poses with 4 to 24; but it tells of the past. The weights are exact for a constant angular acceleration;
/// what that leaves open is least squares over six worlds (VLP-16, HDL-64; by hand, in rooms, on roads), of which any
/// five give the same. At the end of the sweep the error about 16 of their 18 axes is then 4 to 61 % less, and the city
/// comes to 0.029, 0.032 and 0.029 instead of 0.032, 0.036 and 0.029 % (seeds 21 to 23); to 0.028, 0.029 and 0.024 as
/// the accelerations of the next sweep are taken from it, too.
class SweepTurn {
public:
  /// \param registered     motion over the sweep, at its middle
  /// \param sweep_fraction duration of the sweep in periods
  /// \param between        motion per period from the last tracked scan's pose to this one's
  /// \param periods        between those poses
  /// \return the same motion, better turned; as it was after a gap
  SweepMotion refine(const SweepMotion& registered, double sweep_fraction, const Vector6& between, double periods);

private:
  /// Rotations per period, rad, in the sensor's axes.
  struct Turn {
    Eigen::Vector3d during;   ///< the sweep
    Eigen::Vector3d between;  ///< the last pose and this one
  };
  std::optional<Turn> last_;
};

}  // namespace pcl_floam
