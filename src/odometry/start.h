/// \file start.h
/// The first sweeps, until it is settled how the sensor began to move.
#pragma once

#include "odometry/hypotheses.h"

#include <vector>

namespace pcl_floam {

/// Settings of a track for each way in which time may run in sweeps; one if that is known.
[[nodiscard]] std::vector<TrackSettings> eachDirection(const TrackSettings& settings, bool is_known);

/// The first two sweeps hardly tell how the sensor moves on an open road. So several motions are followed for the first
/// sweeps, each by a track of its own, and the one that explains them best stays.
class Start {
public:
  explicit Start(const Sweep& first) : kept_{first} {}

  /// Looks for motions from the first sweep to the second, and keeps that if there are any.
  /// \param[out] hypotheses a track for each motion; none if the sweeps do not fit
  /// \return the registration of the likeliest
  SurfaceRegistration findMotion(const Sweep& second, const TrackSettings& settings, Hypotheses& hypotheses);

  /// The hypotheses take the next sweep.
  /// \return whether any goes on; else the sweep is not kept
  bool step(const Sweep& sweep, Hypotheses& hypotheses);

  /// Whether others explain the sweeps about as well for longer than the first ones usually need to tell.
  [[nodiscard]] bool isUndecided(const Hypotheses& hypotheses) const;

  /// Whether one motion is left, or no more sweeps are waited for.
  [[nodiscard]] bool isOver(const Hypotheses& hypotheses) const;

  /// The best hypothesis of each direction of time stays, its first sweeps where its last ones say they were. Where a
  /// motion leaves no trace, the least is as good as any.
  void settle(Hypotheses& hypotheses) const;

private:
  void suppose(const std::vector<Vector6>& motions, std::vector<Track> tracks, const Sweep& second,
               SurfaceRegistration& first_found, Hypotheses& hypotheses) const;
  [[nodiscard]] bool leavesNoTrace(const Hypotheses& hypotheses) const;
  void beginAgain(Hypothesis& found, const std::vector<SE3>& poses, const std::vector<bool>& keyframes) const;

  std::vector<Sweep> kept_;
};

}  // namespace pcl_floam
