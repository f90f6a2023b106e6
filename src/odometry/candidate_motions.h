/// \file candidate_motions.h
/// First motions that are not followed yet.
#pragma once

#include "odometry/first_motion.h"
#include "odometry/hypotheses.h"
#include "odometry/work_share.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace pcl_floam {

/// Settings of a track for each way in which time may run in sweeps; one if that is known.
[[nodiscard]] std::vector<TrackSettings> eachDirection(const TrackSettings& settings, bool is_known);

/// The first motion that fits is followed at once. The others are sought and tried one after the other while sweeps
/// come, each from the first sweep on, until it has caught up with those that are followed, or fallen behind them.
class CandidateMotions {
public:
  /// \param kept the first two sweeps
  CandidateMotions(const std::vector<Sweep>& kept, const TrackSettings& settings);

  /// \param[out] hypotheses one, unless the sweeps do not fit at all
  /// \return its registration, or the first that failed
  SurfaceRegistration followFirst(const std::vector<Sweep>& kept, Hypotheses& hypotheses);

  /// Goes on as far as a sweep bears it.
  /// \param kept sweeps, all of which the hypotheses have taken
  void goOn(WorkShare& share, const std::vector<Sweep>& kept, Hypotheses& hypotheses);

  /// None in which time runs like that.
  void giveUpDirections(const std::vector<double>& directions);

  /// Whether some are known that are not tried yet.
  [[nodiscard]] bool areWaiting() const { return late_ || !waiting_.empty(); }
  /// Whether all are.
  [[nodiscard]] bool areTried() const { return !late_ && waiting_.empty() && search_.isDone(); }

private:
  struct Candidate {
    Vector6 motion;
    std::size_t direction = 0;  // of time
    bool rests = false;         // along what the first two sweeps do not tell of
  };

  void enqueue();
  [[nodiscard]] bool isGivenUp(double direction) const;
  bool look(WorkShare& share);
  SurfaceRegistration begin(const std::vector<Sweep>& kept);
  void supposeRest(Candidate candidate);
  [[nodiscard]] bool hasJumped(const std::vector<Sweep>& kept) const;
  void compare(const std::vector<Sweep>& kept, Hypotheses& hypotheses);

  FirstMotionSearch search_;
  std::vector<TrackSettings> directions_;
  std::vector<double> given_up_;  // directions
  std::vector<Vector6> enqueued_;
  std::vector<std::size_t> with_rest_;  // directions in which a candidate rests
  std::deque<Candidate> waiting_;
  std::optional<Hypothesis> late_;
};

}  // namespace pcl_floam
