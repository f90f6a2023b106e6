/// \file trajectory_metrics.h
/// Accuracy of a trajectory against ground truth: the KITTI metric, ATE, RPE.
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
  double length = 0.0;         ///< m
  double translation = 0.0;    ///< mean error / length, in percent
  double rotation = 0.0;       ///< mean error / length, in degrees per 100 m
  std::size_t segments = 0;
};

/// KITTI's odometry metric.
struct KittiMetric {
  double translation = 0.0;  ///< t_rel, percent, mean over all sub-sequences
  double rotation = 0.0;     ///< r_rel, degrees per 100 m
  std::size_t segments = 0;  ///< 0 if the trajectory is shorter than every length
  std::vector<SegmentErrors> lengths;
  bool standard_lengths = true;  ///< false when shorter lengths than KITTI's had to be used
};

/// KITTI's lengths, 100 m to 800 m.
[[nodiscard]] std::vector<double> kittiLengths();

/// Lengths for a path too short for KITTI's: tenths of it, at least 3 of them fit.
[[nodiscard]] std::vector<double> lengthsFor(double path_length);

/// Mean relative errors over sub-sequences of the given lengths, one starting at every \p step-th pose
/// (KITTI's development kit: 10).
/// \throws std::invalid_argument if the two differ in size.
[[nodiscard]] KittiMetric kittiMetric(const std::vector<SE3>& estimate, const std::vector<SE3>& truth,
                                      const std::vector<double>& lengths = kittiLengths(), std::size_t step = 10);

/// The rigid motion that brings the estimated positions closest to the true ones (Umeyama, scale 1).
[[nodiscard]] SE3 alignTrajectories(const std::vector<SE3>& estimate, const std::vector<SE3>& truth);

/// Absolute trajectory error in m. \p align: by \ref alignTrajectories; else by the first pose.
[[nodiscard]] ErrorStatistics absoluteTrajectoryError(const std::vector<SE3>& estimate, const std::vector<SE3>& truth,
                                                      bool align = true);

/// Relative pose error between poses \p step apart.
struct RelativePoseError {
  ErrorStatistics translation;  ///< m
  ErrorStatistics rotation;     ///< degrees
};
[[nodiscard]] RelativePoseError relativePoseError(const std::vector<SE3>& estimate, const std::vector<SE3>& truth,
                                                  std::size_t step = 1);

/// Length of the path in m.
[[nodiscard]] double pathLength(const std::vector<SE3>& trajectory);

}  // namespace pcl_floam
