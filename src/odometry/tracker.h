/// \file tracker.h
/// One or more tracks, judged by one evidence.
#pragma once

#include "filters/spatial_sampling.h"
#include "odometry/start.h"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_floam {

/// One track all the time, but for the start (\ref Start), and where nothing tells which way time runs in a sweep: each
/// way has its track then, until one explains the sweeps better.
class Tracker {
public:
  explicit Tracker(const TrackSettings& settings) : settings_(settings) {}

  struct PriorMap {
    std::vector<Eigen::Vector3d> space, edges;
    SE3 guess;  ///< of the next sweep
    bool keeps_map = true;
  };

  /// Sweeps that follow are localised in this map.
  void localizeIn(PriorMap map) { prior_map_ = std::move(map); }

  /// Of several tracks the best one of each direction of time stays, and no pose is corrected any more.
  void keepBest();

  /// The next sweep is sought around here.
  void place(const SE3& pose);

  struct Outcome {
    SurfaceRegistration registration;
    bool corrected = false;      ///< \ref poses are not what they were
    bool changed_track = false;  ///< \ref track is another one
  };

  /// What is to be registered of all returns, and what enters the map.
  void sample(const ScanReturns& returns, Sweep& sweep);

  /// \param sweep \ref sample d; its periods are those since the last sweep that was registered
  Outcome step(const Sweep& sweep);

  /// The map takes in the last sweep, if that is a keyframe: apart, since nothing but the next step waits for it.
  void updateMap(const Sweep& sweep);

  [[nodiscard]] bool hasBegun() const { return start_ || isTracking(); }
  /// Whether a motion is known.
  [[nodiscard]] bool isTracking() const { return !hypotheses_.empty(); }
  /// A pose that the map does not bear out is not called tracked, nor one of a single layer in space. The first
  /// sweeps' map is too young to tell.
  /// \param failure   why there are no scan lines, if there are none
  /// \param explained part of the scan's points that lie on surfaces of the map
  /// \return nullptr: there is none
  [[nodiscard]] const char* reasonToDoubt(ScanLineFailure failure, double explained) const;
  /// Whether the poses since the first one may yet be corrected.
  [[nodiscard]] bool mayCorrect() const { return may_correct_; }
  /// Whether they may by much: several motions are or were followed, or are sought.
  [[nodiscard]] bool isAmbiguous() const
  {
    return may_correct_ && (hypotheses_.size() > 1 || (start_ && (start_->isSearching() || hypotheses_.wereSeveral())));
  }
  /// \ref Track::isBorneOut of the track.
  [[nodiscard]] bool isBorneOut() const { return track().isBorneOut(); }
  [[nodiscard]] const Track& track() const { return hypotheses_.front().track; }
  /// What its pose may be off, as another of the tracks may be the right one.
  [[nodiscard]] Matrix6 rivalCovariance() const { return hypotheses_.rivalCovariance(); }
  /// Of the sweeps since the first one, while \ref mayCorrect and right after; then of some as long as there are
  /// several tracks.
  [[nodiscard]] const std::vector<SweepPose>& poses() const { return hypotheses_.front().poses; }
  /// Of the first sweep, at an instant of it, while \ref poses reach back to it. A sensor that has stood still since
  /// then was where its poses are in the mean.
  [[nodiscard]] SE3 firstPose(double instant) const;

private:
  Outcome beginInPriorMap(const Sweep& sweep);
  Outcome beginWithFirstTwo(const Sweep& sweep);
  Outcome stepAll(const Sweep& sweep);

  TrackSettings settings_;
  SpatialSampling dense_;
  SpatialSampling sampling_;
  std::optional<PriorMap> prior_map_;
  std::optional<Start> start_;  // from the first sweep until it is settled
  int failed_ = 0;              // sweeps in a row that did not fit the first ones
  Hypotheses hypotheses_;
  bool may_correct_ = false;
  std::size_t most_corrected_ = 0;  // sweeps, after which no pose is
};

}  // namespace pcl_floam
