/// \file track.h
/// One hypothesis of how the sensor has moved: a motion and the map that goes with it.
#pragma once

#include "motion/motion_estimate.h"
#include "motion/sweep_pose.h"
#include "odometry/place_search.h"
#include "odometry/sweep.h"
#include "odometry/track_map.h"
#include "odometry/track_settings.h"
#include "odometry/usual_explanation.h"
#include "registration/surface_residuals.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_floam {

/// Of which evidence tells: what was before has faded.
constexpr std::size_t kRememberedSweeps = 5;

/// In what other tracks differ from one.
enum class Rivals : std::uint8_t { none, directions /*of time*/, motions };

/// Where a first motion is sought.
struct FirstLook {
  Vector6 velocity = Vector6::Zero();  ///< per period
  double far = 0.0;                    ///< m, that it may be off
  int rounds = 1;                      ///< each looks half as far as the one before
  bool rests = false;                  ///< along what the sweeps do not tell of; else that stays as it is
};

/// Predict, register, judge, update.
class Track {
public:
  explicit Track(const TrackSettings& settings) : settings_(settings) {}

  /// The first two sweeps share one unknown motion: the first is undistorted with today's estimate of it, and the
  /// second registered with what comes out, again and again, looking less and less far. Tells the pose of the second
  /// and the evidence for it; the track has not begun.
  SurfaceRegistration findMotion(const Sweep& first, const Sweep& second, const FirstLook& look);

  /// Begins at the origin with the motion that the first two sweeps tell.
  SurfaceRegistration begin(const Sweep& first, const Sweep& second, const FirstLook& look);

  /// Begins with sweeps whose poses are known, in the order of time.
  /// \param keyframes of which the map is made
  void begin(const std::vector<Sweep>& sweeps, const std::vector<SweepPose>& poses, const std::vector<bool>& keyframes);

  /// Another track may have the memory of its map.
  void releaseMap() { map_.reset(); }

  /// Its map takes in a sweep whose pose is known.
  void insert(const Sweep& sweep, const SweepPose& pose);

  /// Its map is from now on that of another track, which was made of the same sweeps, whose poses are known better.
  void takeMapOf(Track&& other);

  /// Begins in a map that was made before, of which the pose is roughly known.
  SurfaceRegistration begin(const Sweep& sweep, TrackMap map, const SE3& guess, bool keeps_map);

  /// Takes the next sweep; \ref updateMap goes with it.
  /// \param rivals if there are any, \ref evidence goes on
  SurfaceRegistration step(const Sweep& sweep, Rivals rivals = Rivals::none);

  /// Whether the last sweep may enter the map, which bears it out; any may while it is open how the sensor began to
  /// move.
  [[nodiscard]] bool isBorneOut() const { return explanation_.bearsOut(); }

  /// Whether the last sweep is far enough from those in the map.
  [[nodiscard]] bool isFar() const { return is_keyframe_; }
  /// Whether the map should take it in.
  [[nodiscard]] bool isKeyframe() const { return is_keyframe_ && isBorneOut(); }
  /// The map takes in the last sweep, if that is a keyframe.
  void updateMap(const Sweep& sweep) { updateMap(sweep, isKeyframe()); }
  /// The map takes in the last sweep, if somebody wants it to.
  void updateMap(const Sweep& sweep, bool takes_it);

  /// The next sweep is sought around here.
  void place(const SE3& pose);

  /// Nothing has told how the sensor moved along these directions, for so many periods.
  void forgetAlong(const std::vector<WeakDirection>& directions, double periods);

  [[nodiscard]] const MotionEstimate& motion() const { return motion_; }
  [[nodiscard]] const SweepPose& pose() const { return pose_; }
  [[nodiscard]] double evidence() const { return evidence_; }
  void beginEvidence() { evidence_ = 0.0; }
  [[nodiscard]] const TrackSettings& settings() const { return settings_; }
  /// Duration of the sweep in periods, as time runs on this track.
  [[nodiscard]] double fractionOf(const Sweep& sweep) const
  {
    return sweep.is_direction_known ? sweep.fraction : settings_.direction * sweep.fraction;
  }

private:
  void beginMap();
  void predict(const Sweep& sweep);
  SurfaceRegistration registerPredicted(const Sweep& sweep, Rivals rivals);
  bool seek(const Sweep& sweep, const SurfaceRegistration& found);
  void settle(const Sweep& sweep, const SE3& guess, const Doubt& doubt);
  [[nodiscard]] SurfaceProblem problemFor(const Sweep& sweep) const;
  void update(const Sweep& sweep, const SurfaceRegistration& registration, Rivals rivals);

  TrackSettings settings_;
  std::optional<TrackMap> map_;
  mutable SurfaceRoom room_;
  bool keeps_map_ = true;
  UsualExplanation explanation_;
  int sweeps_to_wait_ = 0;  ///< until the map takes in sweeps again
  bool is_keyframe_ = false;
  MotionEstimate motion_;
  Vector6 velocity_before_ = Vector6::Zero();
  double periods_between_ = 0.0;  ///< since that velocity; 0: none is known
  SweepPose pose_;
  SE3 keyframe_;
  bool is_placed_ = false;            ///< by somebody, roughly
  Matrix6 hinted_ = Matrix6::Zero();  ///< information: what a hint tells of the motion to where the sensor is expected
  double evidence_ = 0.0;
};

/// Those of some poses, in the order of time, at which a map takes in the sweeps.
[[nodiscard]] std::vector<bool> keyframesAmong(const std::vector<SweepPose>& poses, const TrackSettings& settings);

}  // namespace pcl_floam
