/// \file first_scans.h
/// What was given out before it was decided how the sensor began to move, and what it should have been.
#pragma once

#include "odometry/track.h"

#include <pcl_floam/filters/core/features.h>
#include <pcl_floam/odometry/core/odometry_report.h>

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// Scans since the first one: those that were registered, and those between that told nothing.
class FirstScans {
public:
  /// \param features of the first one, as measured
  void begin(const FeatureSet& features);
  /// It is decided: nothing is corrected any more.
  void close() { *this = FirstScans(); }
  [[nodiscard]] bool isOpen() const { return open_; }
  /// A scan comes, so many periods after the last one that was registered.
  void elapse(double periods) { periods_ = periods; }
  /// The scan was registered.
  void add(const FeatureSet& features);
  void miss();
  /// The last one came once more.
  void repeat();
  void give(const SE3& world_T_sensor);

  /// What all scans before this one should have been given; nothing if that is what they were given, to 1 mm.
  std::vector<SE3> correct(const std::vector<SweepPose>& poses, const SE3& world_T_track, double instant);
  /// Whether that was much.
  [[nodiscard]] bool jumped() const { return jumped_; }
  /// Of the last scans that were registered.
  [[nodiscard]] const std::vector<FeatureSet>& features() const { return features_; }

private:
  struct Place {
    std::size_t sweep = 0;
    double periods_after = 0.0;
  };

  bool open_ = false;
  bool jumped_ = false;
  double periods_ = 0.0;
  std::size_t sweep_ = 0;
  std::vector<Place> at_;
  std::vector<SE3> given_;
  std::vector<FeatureSet> features_;
};

/// A covariance in other axes.
[[nodiscard]] Matrix6 turned(const Matrix6& covariance, const SE3& world_T_track);

/// The registration's result in the world's axes.
void turnIntoWorld(OdometryReport& report, const SE3& world_T_track);

}  // namespace pcl_floam
