/// \file start.h
/// The first sweeps, until it is settled how the sensor began to move.
#pragma once

#include "odometry/backward_pass.h"
#include "odometry/candidate_motions.h"
#include "odometry/work_share.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace pcl_floam {

/// The first two sweeps hardly tell how the sensor moved on an open road. So several motions are followed, each by a
/// track of its own, until the others have fallen behind the one that explains the sweeps best, or move as it does.
/// What is more than a sweep's share of that (\ref TrackSettings::start_effort) is left to the sweeps that follow.
class Start {
public:
  explicit Start(const Sweep& first) : kept_{first} {}

  /// Looks for a motion from the first sweep to the second, and keeps that if there is one.
  /// \param[out] hypotheses a track for it; none if the sweeps do not fit
  SurfaceRegistration findMotion(const Sweep& second, const TrackSettings& settings, Hypotheses& hypotheses);

  /// The hypotheses take the next sweep, and the start goes on.
  /// \return whether any goes on; else the sweep is not kept
  bool step(const Sweep& sweep, Hypotheses& hypotheses);

  /// Whether there may be other motions that have not been tried.
  [[nodiscard]] bool isSearching() const { return candidates_ && !candidates_->areTried(); }
  /// Whether one is left: what remains is to find the first sweeps once more, from the last ones.
  [[nodiscard]] bool isDecided() const { return !revisions_.empty(); }
  /// Whether others explain the sweeps about as well for longer than the first ones usually need to tell.
  [[nodiscard]] bool isUndecided(const Hypotheses& hypotheses) const;
  /// Whether the best hypothesis of each direction of time is left, its first sweeps where its last ones say they were.
  [[nodiscard]] bool isSettled() const { return is_settled_; }

private:
  struct Revision {
    std::size_t number = 0;  // of the hypothesis
    BackwardPass pass;
  };

  [[nodiscard]] bool leavesNoTrace(const Hypotheses& hypotheses) const;
  void follow(WorkShare& share, Hypotheses& hypotheses);
  void beginRevision(Hypotheses& hypotheses);
  void revise(WorkShare& share, Hypotheses& hypotheses);
  [[nodiscard]] bool isDone(const BackwardPass& pass) const;
  [[nodiscard]] bool takesMaps() const;
  bool goOn(WorkShare& share, const std::vector<Hypothesis>& all);
  void settle(Hypotheses& hypotheses);

  std::shared_ptr<SpareMaps> spare_maps_ = std::make_shared<SpareMaps>();
  std::vector<Sweep> kept_;  // from the first one on
  bool keeps_ = true;        // all of them
  std::optional<CandidateMotions> candidates_;
  std::vector<Revision> revisions_;  // once it is decided how the sensor moved
  std::vector<bool> keyframes_;      // of the sweeps that are kept: what is made of those after the first ones
  bool leaves_no_trace_ = false;
  bool was_hinted_ = false;
  bool is_settled_ = false;
};

}  // namespace pcl_floam
