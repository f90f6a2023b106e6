/// \file sweep_turn.h
/// How the sensor turns during a sweep, from more than that sweep.
#pragma once

#include <pcl_floam/common/se3.h>

#include <optional>

namespace pcl_floam {

/// The rotation during a sweep from what four measurements say of it: this sweep's and the last one's own registration,
/// the rotation between their poses, and that between the poses before.
///
/// In simulated worlds a sweep's rotation is registered with errors of 12 to 146 millidegrees about an axis, that
/// between two poses with 4 to 24; but it tells of the past. The weights are exact for a constant angular acceleration;
/// what that leaves open is least squares over six worlds (VLP-16, HDL-64; by hand, in rooms, on roads), of which any
/// five give the same.
///
/// The angular acceleration of the next sweep is measured from it.
class SweepTurn {
public:
  /// All per period, in the present sensor's axes.
  /// \param during  the rotation over the sweep as registered, rad
  /// \param between the rotation from the last tracked scan's pose to this one's, rad
  /// \param periods between those poses
  /// \return the rotation over the sweep, better known; as it was after a gap
  Eigen::Vector3d refine(const Eigen::Vector3d& during, const Eigen::Vector3d& between, double periods);

private:
  struct Turn {
    Eigen::Vector3d during;
    Eigen::Vector3d between;
  };
  std::optional<Turn> last_;
};

}  // namespace pcl_floam
