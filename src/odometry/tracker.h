/// \file tracker.h
/// One or more tracks, judged by one evidence.
#pragma once

#include "odometry/first_motion.h"

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// The first two sweeps hardly tell how the sensor moves on an open road. So several motions are followed for the
/// first sweeps, each by a track of its own, and the one that explains them best stays. Where nothing tells which way
/// time runs in a sweep, each way has its tracks, until one explains them better. Otherwise there is one track all the
/// time.
class Tracker {
public:
  explicit Tracker(const TrackSettings& settings) : settings_(settings) {}

  /// Sweeps that follow are localised in this map.
  void localizeIn(const std::vector<Eigen::Vector3d>& space, const std::vector<Eigen::Vector3d>& edges,
                  const SE3& guess, bool keeps_map);

  /// The next sweep is sought around here; of several tracks the best one stays.
  void place(const SE3& pose);

  struct Outcome {
    SurfaceRegistration registration;
    bool corrected = false;      ///< \ref poses are not what they were
    bool changed_track = false;  ///< \ref track is another one
  };

  /// What is to be registered of all returns, and what enters the map.
  void sample(const std::vector<ScanPoint>& points, Sweep& sweep);
  void sample(const ScanReturns& returns, Sweep& sweep);

  /// \param sweep \ref sample d; its periods are those since the last sweep that was registered
  Outcome step(const Sweep& sweep);

  /// The map takes in the last sweep, if that is a keyframe: apart, since nothing but the next step waits for it.
  void updateMap(const Sweep& sweep);

  [[nodiscard]] bool hasBegun() const { return !first_.sample.empty() || !hypotheses_.empty(); }
  /// Whether a motion is known.
  [[nodiscard]] bool isTracking() const { return !hypotheses_.empty(); }
  /// Whether it is not decided yet how the sensor began to move.
  [[nodiscard]] bool isOpen() const { return is_open_; }
  /// Whether that is open for longer than the first sweeps usually need to tell: others explain them about as well.
  [[nodiscard]] bool isUndecided() const;
  /// Whether the poses since the first one may yet be corrected.
  [[nodiscard]] bool mayCorrect() const { return may_correct_; }
  /// Whether they may since several motions are followed.
  [[nodiscard]] bool isAmbiguous() const { return may_correct_ && hypotheses_.size() > 1; }
  [[nodiscard]] const Track& track() const { return hypotheses_.front().track; }
  /// Of the sweeps since the first one, while \ref mayCorrect and right after; then of some as long as there are
  /// several tracks.
  [[nodiscard]] const std::vector<SweepPose>& poses() const { return hypotheses_.front().poses; }

private:
  struct Hypothesis {
    Track track;
    std::vector<SweepPose> poses;
    SurfaceRegistration last;
    bool is_lost = false;
    std::size_t number = 0;
    std::size_t without_trace = 0;  ///< first sweeps that did not tell of a direction

    [[nodiscard]] double direction() const { return track.settings().direction; }
    [[nodiscard]] double evidence() const;
    [[nodiscard]] double moved() const;
  };
  struct PriorMap {
    std::vector<Eigen::Vector3d> space, edges;
    SE3 guess;
    bool keeps_map = true;
  };

  Outcome begin(const Sweep& sweep);
  Outcome beginInPriorMap(const Sweep& sweep);
  Outcome findFirstMotion(const Sweep& sweep);
  void suppose(const FirstMotions& motions, const Sweep& sweep, const TrackSettings& settings, Outcome& outcome);
  void suppose(const SurfaceRegistration& found, Track track, Outcome& outcome);
  void followUp(const Sweep& sweep, Outcome& outcome);
  bool stepAll(const Sweep& sweep);
  void giveUp(double behind);
  void settle();
  void settle(Hypothesis& found, const std::vector<SE3>& poses, const std::vector<bool>& keyframes,
              bool leaves_no_trace) const;
  void keepOneOfEachDirection(bool (*isBefore)(const Hypothesis&, const Hypothesis&));
  [[nodiscard]] bool hasRivals() const;
  [[nodiscard]] bool leavesNoTrace() const;
  static bool isLikelier(const Hypothesis& a, const Hypothesis& b);
  static bool hasMovedLess(const Hypothesis& a, const Hypothesis& b);
  [[nodiscard]] std::vector<TrackSettings> directions(bool are_known) const;

  TrackSettings settings_;
  SpatialSampling dense_;
  SpatialSampling sampling_;
  double side_ = 0.0;                // m, of the finest cells; 0 until the first sweep
  std::vector<PriorMap> prior_map_;  // none or one
  Sweep first_;
  int failed_ = 0;
  std::vector<Hypothesis> hypotheses_;  // the likeliest first
  std::size_t numbered_ = 0;
  bool is_open_ = false;
  bool may_correct_ = false;
  std::vector<Sweep> kept_;  // while open
};

}  // namespace pcl_floam
