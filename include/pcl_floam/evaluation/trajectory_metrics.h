/// \file trajectory_metrics.h
/// Accuracy of a trajectory against ground truth, the KITTI metric, ATE, RPE, and against rest.
#pragma once

#include <pcl_floam/common/se3.h>

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// Mean, root mean square, median and largest of a set of errors.
struct ErrorStatistics {
  double mean = 0.0;
  double rms = 0.0;
  double median = 0.0;
  double max = 0.0;
  std::size_t count = 0;
};

/// Errors over the sub-sequences of one length.
struct SegmentErrors {
  double length = 0.0;       ///< m
  double translation = 0.0;  ///< mean error / length, in percent
  double rotation = 0.0;     ///< mean error / length, in degrees per 100 m
  std::size_t segments = 0;
};

/// KITTI's odometry metric.
struct KittiMetric {
  double translation = 0.0;            ///< t_rel, percent, mean over all sub-sequences
  double rotation = 0.0;               ///< r_rel, degrees per 100 m
  std::size_t segments = 0;            ///< 0 if the trajectory is shorter than every length
  std::vector<SegmentErrors> lengths;  ///< those that fit
  bool standard_lengths = true;  ///< KITTI's lengths and step; figures of others do not compare with the benchmark's
  std::size_t step = 10;         ///< poses from one sub-sequence's start to the next one's
};

/// KITTI's lengths, 100 m to 800 m.
[[nodiscard]] std::vector<double> kittiLengths();

/// Lengths that suit a path: KITTI's from 200 m on. A shorter path has room for a handful of 100 m sub-sequences at
/// most, so it gets KITTI's lengths scaled down: 1 to 8 times the largest of 1, 2, 5, 10, 20, ... m (or 0.5, 0.2, ...)
/// that is no more than a tenth of it, e.g. 10 to 80 m for 107 m.
[[nodiscard]] std::vector<double> lengthsFor(double path_length);

/// Mean relative errors over sub-sequences of the given lengths of the true path, one starting at every \p step-th
/// pose. By default exactly as KITTI's development kit.
/// \throws std::invalid_argument if the two differ in size, or if a length or the step is not greater than 0.
[[nodiscard]] KittiMetric kittiMetric(const std::vector<SE3>& estimate, const std::vector<SE3>& truth,
                                      const std::vector<double>& lengths = kittiLengths(), std::size_t step = 10);

/// \ref kittiMetric with the lengths that suit the path (\ref lengthsFor); where they are not KITTI's, with a
/// sub-sequence from every pose.
/// \throws std::invalid_argument if the two differ in size.
[[nodiscard]] KittiMetric fittingKittiMetric(const std::vector<SE3>& estimate, const std::vector<SE3>& truth);

/// The rigid motion that brings the estimated positions closest to the true ones (Umeyama, scale 1).
[[nodiscard]] SE3 alignTrajectories(const std::vector<SE3>& estimate, const std::vector<SE3>& truth);

/// Absolute trajectory error in m. \p align: by \ref alignTrajectories; else by the first pose.
[[nodiscard]] ErrorStatistics absoluteTrajectoryError(const std::vector<SE3>& estimate, const std::vector<SE3>& truth,
                                                      bool align = true);

/// Statistics of the relative pose error.
struct RelativePoseError {
  ErrorStatistics translation;  ///< m
  ErrorStatistics rotation;     ///< degrees
};

/// Errors of the motions between poses \p step apart.
/// \throws std::invalid_argument if the two differ in size or \p step is 0.
[[nodiscard]] RelativePoseError relativePoseError(const std::vector<SE3>& estimate, const std::vector<SE3>& truth,
                                                  std::size_t step = 1);

/// How far from rest the poses are of a sensor that is known to be at rest: all of it is error.
struct RestMetric {
  double wander = 0.0;           ///< m, largest distance of a pose from the first one
  double drift = 0.0;            ///< m, distance of the last pose from the first one
  double rotation_wander = 0.0;  ///< degrees, largest angle of a pose to the first one; up to 180
  double rotation_drift = 0.0;   ///< degrees, angle of the last pose to the first one
  RelativePoseError jitter;      ///< of the motions from each pose to the next one
};

/// \return zeros without poses, and a jitter of count 0 for a single one
[[nodiscard]] RestMetric restMetric(const std::vector<SE3>& trajectory);

/// Length of the path in m.
[[nodiscard]] double pathLength(const std::vector<SE3>& trajectory);

}  // namespace pcl_floam
