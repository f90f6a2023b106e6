/// \file lidar.h
/// The lidars that can be simulated.
#pragma once

#include "random.h"
#include "ray_scene.h"
#include "scan_pattern.h"

#include <string>
#include <string_view>
#include <vector>

namespace pcl_floam::simulator {

/// Sense of the head's rotation seen from above.
enum class HeadRotation { clockwise, counterclockwise };

/// A lidar's geometry and reach.
struct Lidar {
  std::string name;
  /// rad, by ring: Velodyne numbers its rings from the lowest, Ouster from the top. Where no head turns: so many
  /// lasers.
  std::vector<double> elevations;
  int columns = 1800;        ///< firings in one sweep at 10 Hz, each of all lasers at once
  double min_range = 0.5;    ///< m
  double max_range = 100.0;  ///< m
  ScanPattern pattern = ScanPattern::turning;

  [[nodiscard]] int rings() const { return static_cast<int>(elevations.size()); }

  /// Whether it is one of Livox's, whose drivers write other fields.
  [[nodiscard]] bool isLivox() const { return pattern != ScanPattern::turning && pattern != ScanPattern::flash; }

  /// Where a laser looks.
  /// \param time s since the sensor was switched on
  [[nodiscard]] BeamDirection direction(int ring, double column, double time, HeadRotation rotation) const;

  /// Azimuth of a firing in rad, counter-clockwise from the sensor's x axis, in (-pi, pi]. A turn begins and ends at
  /// the rear and looks forward at its middle.
  [[nodiscard]] double azimuth(double column, HeadRotation rotation) const;

  /// Whether the echo of a surface is strong enough to be seen: bright, near and head-on surfaces surely are, dark,
  /// far and grazing ones with falling probability.
  [[nodiscard]] bool detects(const RayHit& hit, Random& random) const;
};

/// vlp16, hdl32, hdl64, os64, os128, mid360, avia, hap or flash.
/// \throws std::invalid_argument for an unknown name; the message lists the known ones.
[[nodiscard]] Lidar lidar(std::string_view name);

/// The names that \ref lidar knows.
[[nodiscard]] const std::vector<std::string>& lidarNames();

}  // namespace pcl_floam::simulator
