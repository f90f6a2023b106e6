/// \file weak_directions.h
/// Directions of motion that surfaces do not hold.
#pragma once

#include "registration/cloud_alignment.h"

#include <vector>

namespace pcl_floam {

/// What holds a cloud along its surfaces is measured. Each match pulls a point to its nearest neighbour, as if it
/// belonged there: within a surface that is noise, which goes along with the cloud wherever it is moved, and only at
/// outlines and on few shapes it is not. So the cloud is moved to both sides, and matched again: the share of the pull
/// that comes back is what counts.
class WeakDirections {
public:
  /// \param weak share of the largest eigenvalue below which surfaces do not hold a direction
  WeakDirections(CloudAlignment& alignment, CloudMatching& level, double weak);

  /// Goes along those directions that something holds to where its pull ends, and back to \p guess along the others.
  /// \return whether it came to an end
  bool settle(const SE3& guess, double epsilon);

  /// How much of their eigenvalues is true, from 0 to 1, in the order of the analysis.
  [[nodiscard]] std::vector<double> shares();

private:
  [[nodiscard]] double share(const InformationAnalysis& analysis, int direction);
  [[nodiscard]] double pull(const Vector6& motion, double way);
  [[nodiscard]] Vector6 step(const SE3& guess, Motions& weak);

  CloudAlignment& alignment_;
  CloudMatching& level_;
  double weak_;
};

}  // namespace pcl_floam
