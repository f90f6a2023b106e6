/// \file start_search.h
/// Where to begin with the full clouds.
#pragma once

#include "registration/cloud_alignment.h"

#include <vector>

namespace pcl_floam {

/// Finds a start from the guess with thinned clouds, in two ways. Points drawn to points come from far, but are drawn
/// to where both clouds are dense, and to the sensor's pattern on the ground. Surfaces drawn to surfaces are not, but
/// have to be near. The better of both is taken.
class StartSearch {
public:
  /// \param alignment at the guess
  StartSearch(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run,
              CloudAlignment& alignment);

  /// Leaves the alignment at the start.
  void find();

private:
  void drawPoints();
  void drawPoints(const CloudLevel& source, const CloudLevel& target, double& along);
  void drawSurfaces(const SE3& start);
  void align(LevelAlignment level);
  [[nodiscard]] LevelAlignment surfaces(std::size_t level) const;
  [[nodiscard]] double cost(std::size_t level, const SE3& pose) const;

  const CloudPyramid& source_;
  const CloudPyramid& target_;
  const CloudRegistrationRun& run_;
  CloudAlignment& alignment_;
  std::vector<CloudLevel> sources_;  ///< the source in the voxels of the target's levels
};

}  // namespace pcl_floam
