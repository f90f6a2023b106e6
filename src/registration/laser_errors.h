/// \file laser_errors.h
/// What all points of a laser are off by alike.
#pragma once

#include "registration/normal_equations.h"

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Each laser points a little higher or lower than it is said to, and all its points with it: a residual is
/// r + J x + j e, with x of pose and velocity and one angle e for each laser, of which no more is known than how large
/// it may be. The equations become those of x whatever the angles are (Schur complement), so that no ring, however
/// many points it has, draws the sensor along with it.
class LaserErrors {
public:
  /// \param raised       j: by how much the residual grows as the laser is raised, m per rad
  /// \param jacobian     J by the pose
  /// \param since_middle J by the velocity is so many times that
  void add(std::uint32_t laser, double raised, const Eigen::Matrix<double, 6, 1>& jacobian, double residual,
           double weight, double since_middle);

  void add(const LaserErrors& other);

  /// \param known of each angle before, 1 / rad^2, in the equations' units
  void takeFrom(NormalEquations& equations, double known) const;

private:
  struct Angle {
    std::uint32_t laser = 0;
    double information = 0.0;              ///< sum w j^2
    double gradient = 0.0;                 ///< sum w j r
    Vector6 coupling = Vector6::Zero();    ///< sum w j J
    Vector6 with_twist = Vector6::Zero();  ///< the same by the velocity
  };

  Angle& of(std::uint32_t laser);

  std::vector<Angle> angles_;  // in the order of the lasers
};

}  // namespace pcl_floam
