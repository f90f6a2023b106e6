/// \file backward_pass.h
/// The first sweeps once more, from the last one.
#pragma once

#include "odometry/track.h"

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// Finds the poses of the first sweeps with the map that the last ones make: those know better how the sensor moved.
class BackwardPass {
public:
  /// \param kept sweeps
  /// \param forwards poses that were found of them, of which the last ones are trusted
  BackwardPass(const std::vector<Sweep>& kept, const std::vector<SE3>& forwards, const TrackSettings& settings);

  [[nodiscard]] bool isDone() const { return left_ == 0; }
  /// Registers the next sweep before.
  void step(const std::vector<Sweep>& kept);
  /// Of all sweeps, where the first one is the origin.
  /// \param later poses of sweeps that came since it began, as they were found forwards
  /// \return none if a sweep was not found
  [[nodiscard]] std::vector<SE3> poses(const std::vector<SE3>& forwards) const;

private:
  Track back_;
  std::vector<SE3> poses_;  // of the first sweeps, as found backwards; those trusted forwards
  std::size_t left_ = 0;
  bool is_lost_ = false;
};

}  // namespace pcl_floam
