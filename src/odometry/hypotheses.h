/// \file hypotheses.h
/// Tracks side by side, judged by one evidence.
#pragma once

#include "odometry/track.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// A track among others.
struct Hypothesis {
  Track track;
  std::vector<SweepPose> poses;  ///< of the sweeps since the first one, as far as they may be corrected
  SurfaceRegistration last;
  bool is_lost = false;
  std::size_t number = 0;
  std::size_t without_trace = 0;  ///< first sweeps that did not tell of a direction

  [[nodiscard]] double direction() const { return track.settings().direction; }
  [[nodiscard]] double evidence() const;
  [[nodiscard]] double moved() const;  ///< m, from the first sweep on
};

/// Which is the best one.
enum class Preference : std::uint8_t { likeliest, least_motion };

/// The likeliest first. Where nothing tells which way time runs in a sweep, each way has its tracks.
class Hypotheses {
public:
  [[nodiscard]] bool empty() const { return all_.empty(); }
  [[nodiscard]] std::size_t size() const { return all_.size(); }
  [[nodiscard]] const Hypothesis& front() const { return all_.front(); }
  [[nodiscard]] Hypothesis& front() { return all_.front(); }
  [[nodiscard]] std::vector<Hypothesis>& all() { return all_; }

  /// Follows a track, unless its motion is followed already: then the likelier one.
  void add(Track track, const SurfaceRegistration& last, const std::vector<SweepPose>& poses);

  /// Each takes the next sweep. Each map takes in its own keyframes while rivals are motions, else all the same ones: a
  /// map that has just taken in a sweep explains the next one better, whatever is right.
  /// \param keeps_poses whether they may be corrected later
  /// \return whether any goes on
  bool step(const Sweep& sweep, Rivals rivals, bool keeps_poses);

  /// Those that match no more, or have fallen behind the best one by so much evidence, and all but a few of each
  /// direction of time.
  /// \param rivals with which each is compared: motions within its direction of time
  void giveUp(double behind, Rivals rivals);

  /// \ref front becomes the one that is preferred.
  void putFirst(Preference preference);

  /// Their evidence begins anew, so that what is left to tell is the direction.
  void keepOneOfEachDirection(Preference preference);

  /// Whether the best one's direction of time has others.
  [[nodiscard]] bool hasRivalsInDirection() const;

private:
  void updateMaps(const Sweep& sweep);

  std::vector<Hypothesis> all_;
  std::size_t numbered_ = 0;
};

}  // namespace pcl_floam
