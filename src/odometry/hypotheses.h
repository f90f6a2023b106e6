/// \file hypotheses.h
/// Tracks side by side, judged by one evidence.
#pragma once

#include "odometry/track.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace pcl_floam {

/// Sweeps until it is decided how the sensor began to move, if one motion is left by then.
constexpr std::size_t kFirstSweeps = 12;

/// First sweeps that are kept.
constexpr std::size_t kMostKept = 96;

/// A track among others.
struct Hypothesis {
  Hypothesis(Track begun, const SurfaceRegistration& found)
      : track(std::move(begun)), last(found), is_beginning_told(found.report.weak_directions.empty())
  {
  }

  /// Takes the next sweep, and with it what others need to compare themselves, if \p keeps_poses. Its map takes the
  /// sweep in if rivals are motions.
  void step(const Sweep& sweep, Rivals rivals, bool keeps_poses);

  Track track;
  std::vector<SweepPose> poses;   ///< of the sweeps since the first one, as far as they may be corrected
  std::vector<double> evidences;  ///< as each was taken
  /// Of the places of each sweep, while rivals are motions; empty where it is not needed.
  std::vector<std::vector<float>> place_evidences;
  SurfaceRegistration last;
  bool is_beginning_told = true;  ///< of all directions
  bool is_lost = false;
  std::size_t number = 0;
  std::size_t without_trace = 0;  ///< first sweeps that did not tell of a direction

  [[nodiscard]] double direction() const { return track.settings().direction; }
  [[nodiscard]] double evidence() const { return is_lost ? -HUGE_VAL : track.evidence(); }
  /// m, from the first sweep on.
  [[nodiscard]] double moved() const { return is_lost ? HUGE_VAL : track.pose().middle.translation.norm(); }

private:
  void keepEvidenceOf(const std::vector<std::uint32_t>& places);
};

/// A direction of time whose evidence is so much less than the best one's is given up, once it is settled how the
/// sensor began to move: of the sweeps that it remembers, in which nothing else differs. Nor do maps but for keyframes
/// among the first sweeps, unless these were not found once more, or more came than are kept. Before that it takes
/// twice as much, since each map has taken in keyframes of its own.
constexpr double kWrongDirection = 15.0;

/// Which is the best one.
enum class Preference : std::uint8_t { likeliest, least_motion };

/// The one that is given out first. Where nothing tells which way time runs in a sweep, each way has its tracks.
class Hypotheses {
public:
  [[nodiscard]] bool empty() const { return all_.empty(); }
  [[nodiscard]] std::size_t size() const { return all_.size(); }
  [[nodiscard]] const Hypothesis& front() const { return all_.front(); }
  [[nodiscard]] Hypothesis& front() { return all_.front(); }
  [[nodiscard]] std::vector<Hypothesis>& all() { return all_; }

  /// Follows another.
  void add(Hypothesis added);

  /// Each takes the next sweep. Each map takes in its own keyframes while rivals are motions, else all the same ones: a
  /// map that has just taken in a sweep explains the next one better, whatever is right.
  /// \param keeps_poses whether they may be corrected later
  /// \return whether any goes on
  bool step(const Sweep& sweep, Rivals rivals, bool keeps_poses);

  /// Whether all maps took in the last sweep.
  [[nodiscard]] bool tookIn() const { return took_in_; }

  /// Those that match no more, or surely explain the last sweeps worse than another one of their direction of time, or
  /// have come to move as a likelier one does, and all but a few of each direction. The likeliest becomes the first.
  void giveUpMotions();

  /// Those that match no more, or have fallen behind the best one by so much evidence. The first one stays that until
  /// then: what is less is noise, by which poses would go back and forth.
  /// \return the directions of those that were given up
  std::vector<double> giveUpDirections(double behind);

  /// Whether all have begun with one motion.
  [[nodiscard]] bool differInDirectionAlone() const;

  /// Whether a late one surely explains sweeps worse up to the one that it took last, or is no other than one that is
  /// about as likely.
  [[nodiscard]] bool haveLeftBehind(const Hypothesis& late) const;

  /// Those that once did so beside one that has caught up.
  void dropLeftBehind(const Hypothesis& late);

  /// Those that match no more, unless all do.
  void dropLost();

  /// \ref front becomes the one that is preferred.
  void putFirst(Preference preference);

  /// Their evidence begins anew, so that what is left to tell is the direction.
  void keepOneOfEachDirection(Preference preference);

  /// Whether more than one was ever followed.
  [[nodiscard]] bool wereSeveral() const { return numbered_ > 1; }

  /// Mean square of what the first one's pose is off if another one is right, each as likely; zero without others.
  [[nodiscard]] Matrix6 rivalCovariance() const;

  /// Whether the best one's direction of time has others.
  [[nodiscard]] bool hasRivalsInDirection() const;

private:
  std::vector<Hypothesis> all_;
  bool took_in_ = false;
  std::size_t numbered_ = 0;
};

}  // namespace pcl_floam
