#include "odometry/scan_sample.h"

#include "odometry/vertical_correction.h"

#include <algorithm>

namespace pcl_floam {

std::vector<Eigen::Vector3f> undistortedSample(const CloudView& scan, const ScanLines& lines, const ScanTiming& timing,
                                               const FeatureParameters& ranges, double vertical_correction,
                                               const SweepMotion& motion)
{
  constexpr int kMost = 12000;
  const int per_line = std::max(1, kMost / std::max(1, static_cast<int>(lines.lines())));
  FeatureSet measured;
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    const int step = std::max(1, (lines.begin[m + 1] - lines.begin[m]) / per_line);
    for (std::int32_t n = lines.begin[m] + static_cast<std::int32_t>(m) % step; n < lines.begin[m + 1]; n += step) {
      const std::int32_t index = lines.index[static_cast<std::size_t>(n)];
      const auto i = static_cast<std::size_t>(index);
      const Eigen::Vector3f point(scan.x(i), scan.y(i), scan.z(i));
      const auto range = static_cast<double>(point.norm());
      if (range >= ranges.min_range && range <= ranges.max_range) {
        Feature feature;
        feature.x = point.x();
        feature.y = point.y();
        feature.z = point.z();
        feature.time = timing.at(scan, i);
        feature.index = index;
        measured.planes.push_back(feature);
      }
    }
  }
  correctVerticalAngle(vertical_correction, measured);
  std::vector<Feature> undistorted;
  compensate(measured.planes, motion, undistorted);
  std::vector<Eigen::Vector3f> points;
  points.reserve(undistorted.size());
  for (const Feature& feature : undistorted) {
    points.emplace_back(feature.x, feature.y, feature.z);
  }
  return points;
}

}  // namespace pcl_floam
