#include "odometry/scan_sample.h"

#include "odometry/vertical_correction.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// The nearest of the points \p begin to \p end of the lines, of those within range; -1 if none is.
std::int32_t nearestOf(const CloudView& scan, const ScanLines& lines, std::int32_t begin, std::int32_t end,
                       const FeatureParameters& ranges)
{
  const float nearest = ranges.min_range * ranges.min_range;
  float least = ranges.max_range * ranges.max_range;
  std::int32_t found = -1;
  for (std::int32_t n = begin; n < end; ++n) {
    const std::int32_t index = lines.index[static_cast<std::size_t>(n)];
    const auto i = static_cast<std::size_t>(index);
    const float squared_range = Eigen::Vector3f(scan.x(i), scan.y(i), scan.z(i)).squaredNorm();
    if (squared_range >= nearest && squared_range < least) {
      least = squared_range;
      found = index;
    }
  }
  return found;
}

Feature featureAt(const CloudView& scan, const ScanTiming& timing, std::int32_t index)
{
  const auto i = static_cast<std::size_t>(index);
  Feature feature;
  feature.x = scan.x(i);
  feature.y = scan.y(i);
  feature.z = scan.z(i);
  feature.time = timing.at(scan, i);
  feature.index = index;
  return feature;
}

}  // namespace

std::vector<Eigen::Vector3f> undistortedSample(const CloudView& scan, const ScanLines& lines, const ScanTiming& timing,
                                               const FeatureParameters& ranges, double vertical_correction,
                                               const SweepMotion& motion)
{
  constexpr int kAbout = 12000;
  const int per_line = std::max(1, kAbout / std::max(1, static_cast<int>(lines.lines())));
  FeatureSet measured;
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    const std::int32_t count = lines.begin[m + 1] - lines.begin[m];
    const std::int32_t step = (count + per_line - 1) / per_line;
    for (std::int32_t n = lines.begin[m]; n < lines.begin[m + 1]; n += step) {
      const std::int32_t nearest = nearestOf(scan, lines, n, std::min(n + step, lines.begin[m + 1]), ranges);
      if (nearest >= 0) {
        measured.planes.push_back(featureAt(scan, timing, nearest));
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
