/// \file backward_pass.h
/// The first sweeps once more, from later ones.
#pragma once

#include "odometry/track.h"
#include "odometry/work_share.h"

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// Finds the poses of the first sweeps with the map that later ones make: those know better how the sensor moved. Then
/// that map takes in the sweeps that have come since.
class BackwardPass {
public:
  static constexpr std::size_t kTrusted = 4;  ///< last poses, from which the others are found

  /// \param forwards poses that were found of the first sweeps, more than those that are trusted
  BackwardPass(std::vector<SweepPose> forwards, const TrackSettings& settings);

  [[nodiscard]] bool isDone() const { return left_ == 0; }
  /// Makes the map of the trusted sweeps, then registers the next sweep before, as far as the share goes.
  /// \return whether it did
  bool step(const std::vector<Sweep>& kept, WorkShare& share);
  /// Whether all were found.
  [[nodiscard]] bool hasFound() const { return isDone() && !found_.empty(); }
  /// Of all sweeps, those from the trusted ones on as they were found forwards. \pre \ref hasFound
  [[nodiscard]] std::vector<SweepPose> poses(std::vector<SweepPose> forwards) const;

  /// So many sweeps, from the first one on, are in its map once it \ref hasFound.
  [[nodiscard]] std::size_t inMap() const { return in_map_; }
  /// The next one comes in, if it is a keyframe.
  void takeNext(const Sweep& sweep, const SweepPose& pose, bool is_keyframe);
  [[nodiscard]] Track& track() { return back_; }

private:
  void begin(const std::vector<Sweep>& kept);
  void findNext(const std::vector<Sweep>& kept);

  Track back_;
  std::vector<SweepPose> forwards_;
  std::vector<SweepPose> found_;  // before the trusted ones
  std::size_t count_ = 0;         // of sweeps when it began
  std::size_t left_ = 0;          // to be found
  bool has_begun_ = false;
  std::size_t in_map_ = 0;
};

}  // namespace pcl_floam
