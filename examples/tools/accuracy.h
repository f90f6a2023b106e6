/// \file accuracy.h
/// All figures of a trajectory's accuracy, as text and as JSON.
#pragma once

#include "pose_pairs.h"

#include <pcl_floam/evaluation/trajectory_metrics.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace pcl_floam::tools {

using Json = nlohmann::ordered_json;

struct AccuracyOptions {
  std::vector<double> lengths;  ///< m, of the KITTI metric; empty: what suits the path
  std::size_t step = 0;         ///< poses between the starts of sub-sequences; 0: what suits the lengths
  std::size_t rpe_step = 1;
  bool align = true;  ///< before ATE: by SE(3) alignment; else by the first pose
};

struct Accuracy {
  std::size_t poses = 0;
  double path_length = 0.0;  ///< m, of the ground truth
  KittiMetric kitti;         ///< with lengths that suit the path, or the user's
  KittiMetric standard;      ///< with KITTI's lengths; without sub-sequences if none fits
  ErrorStatistics ate;
  RelativePoseError rpe;
  AccuracyOptions options;
};

[[nodiscard]] Accuracy measureAccuracy(const PosePairs& pairs, const AccuracyOptions& options);

[[nodiscard]] Json toJson(const Accuracy& accuracy);

/// Lines for a reader, without a final line end.
[[nodiscard]] std::string describe(const Accuracy& accuracy);

/// Which sub-sequences the KITTI metric was taken over.
[[nodiscard]] std::string describeLengths(const Accuracy& accuracy);

/// Whether these are the standard ones, so that the figures compare with the benchmark's.
[[nodiscard]] std::string describeStandard(const Accuracy& accuracy);

}  // namespace pcl_floam::tools
