/// \file first_scans.h
/// The first scans of a drive, and what the odometry makes of them.
#pragma once

#include "simulator/test_world.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace pcl_floam::simulator {

inline constexpr int kLongest = 120;  ///< scans until most starts are settled
inline constexpr int kFirst = 13;     ///< scans whose poses are corrected then

struct Start {
  unsigned seed;
  double seconds;        // into the drive
  double dropout = 0.0;  // part of the returns that is missing
  std::string sensor = "hdl64";
};

/// Unlike other reasons for doubt: what scans tell is seen less and less well on an open road.
inline bool saysSeveralExplain(const OdometryReport& report)
{
  return report.reason.find("several motions explain") != std::string::npos;
}

inline SimulationOptions optionsOf(const Start& start)
{
  SimulationOptions options = testWorld("highway", start.sensor);
  options.seed = start.seed;
  options.start = start.seconds;
  options.dropout = start.dropout;
  return options;
}

/// The first sweeps, and what the odometry makes of them.
class FirstScans {
public:
  explicit FirstScans(const SimulationOptions& options, int effort = OdometryParameters().start_effort)
      : simulation_(options), odometry_(withEffort(effort))
  {
  }

  const OdometryReport& next()
  {
    const Sweep sweep = simulation_.sweep(number_);
    truth_.push_back(sweep.world_T_end);
    return note(odometry_.track(sweep.cloud, stamp()));
  }

  const OdometryReport& miss()
  {
    truth_.push_back(simulation_.sweep(number_).world_T_end);
    return note(odometry_.trackMissing(stamp()));
  }

  /// m, from the last but one scan to the last.
  [[nodiscard]] double trueMotion() const
  {
    return (truth_[truth_.size() - 2].inverse() * truth_.back()).translation.norm();
  }

  /// m; of the last scan's motion and, since the first, of all.
  [[nodiscard]] double motionError() const { return error(truth_.size() - 2, truth_.size() - 1); }
  [[nodiscard]] double wayError() const { return error(0, truth_.size() - 1); }

  /// m, since the first scan, with what was corrected: the greatest of the first scans.
  [[nodiscard]] double greatestWayError(std::size_t scans) const
  {
    double greatest = 0.0;
    for (std::size_t i = 1; i < scans; ++i) {
      greatest = std::max(greatest, error(0, i));
    }
    return greatest;
  }

  /// m: by how much the last scan changed poses before, at most.
  [[nodiscard]] double correctedBy() const { return corrected_by_; }

private:
  static OdometryParameters withEffort(int effort)
  {
    OdometryParameters parameters;
    parameters.start_effort = effort;
    return parameters;
  }

  [[nodiscard]] double stamp() const { return 0.1 * static_cast<double>(number_); }

  const OdometryReport& note(const OdometryReport& report)
  {
    EXPECT_LE(report.corrected_poses.size(), estimate_.size());
    corrected_by_ = 0.0;
    for (std::size_t i = 0; i < report.corrected_poses.size(); ++i) {
      const SE3& before = estimate_[estimate_.size() - report.corrected_poses.size() + i];
      corrected_by_ = std::max(corrected_by_, (report.corrected_poses[i].translation - before.translation).norm());
    }
    std::copy(report.corrected_poses.begin(), report.corrected_poses.end(),
              estimate_.end() - static_cast<std::ptrdiff_t>(report.corrected_poses.size()));
    estimate_.push_back(report.world_T_sensor);
    ++number_;
    return report;
  }

  [[nodiscard]] double error(std::size_t since, std::size_t scan) const
  {
    const SE3 true_motion = truth_[since].inverse() * truth_[scan];
    const SE3 motion = estimate_[since].inverse() * estimate_[scan];
    return (motion.translation - true_motion.translation).norm();
  }

  Simulation simulation_;
  Odometry<PointXYZIRT> odometry_;
  std::vector<SE3> truth_;
  std::vector<SE3> estimate_;
  std::size_t number_ = 0;
  double corrected_by_ = 0.0;
};

}  // namespace pcl_floam::simulator
