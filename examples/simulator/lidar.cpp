#include "lidar.h"

#include <pcl_floam/filters/core/sensor_model.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_floam::simulator {

namespace {

struct Specification {
  const char* name;
  int columns;  ///< Velodyne: rate of the lasers' firing cycle over 10 Hz; Ouster: a usual mode
  double min_range, max_range;
  bool top_first;
};

constexpr Specification kSpecifications[] = {{"vlp16", 1800, 0.5, 100.0, false},
                                             {"hdl32", 2170, 0.9, 80.0, false},
                                             {"hdl64", 2083, 0.9, 120.0, false},
                                             {"os64", 1024, 0.5, 100.0, true},
                                             {"os128", 1024, 0.5, 100.0, true}};

/// Lidars without a head that turns: the rate of points and the reach are the makers'; 20,000, 24,000 and 45,300 points
/// in a tenth of a second.
struct SolidState {
  const char* name;
  ScanPattern pattern;
  int lasers, columns;
  double min_range, max_range;
};

constexpr SolidState kSolidState[] = {{"mid360", ScanPattern::woven, 4, 5000, 0.1, 70.0},
                                      {"avia", ScanPattern::rosette, 6, 4000, 1.0, 190.0},
                                      {"hap", ScanPattern::swept, 6, 7550, 0.5, 150.0},
                                      {"flash", ScanPattern::flash, 60, 120, 0.2, 50.0}};

/// Echo strength, relative to a white surface head-on at the greatest range, that half of the pulses are seen at.
constexpr double kThreshold = 0.1;

/// Rough surfaces send something back even when grazed.
constexpr double kRoughness = 0.15;

}  // namespace

double Lidar::azimuth(double column, HeadRotation rotation) const
{
  const double angle = M_PI - 2.0 * M_PI * column / columns;
  return rotation == HeadRotation::clockwise || column <= 0.0 ? angle : -angle;
}

BeamDirection Lidar::direction(int ring, double column, double time, HeadRotation rotation) const
{
  if (pattern == ScanPattern::turning) {
    return {azimuth(column, rotation), elevations[static_cast<std::size_t>(ring)]};
  }
  return pattern == ScanPattern::flash ? pixelDirection(ring, rings(), static_cast<int>(column), columns)
                                       : beamDirection(pattern, ring, rings(), time);
}

bool Lidar::detects(const RayHit& hit, Random& random) const
{
  if (hit.distance < min_range) {
    return false;
  }
  const double spread = max_range / hit.distance;
  const double strength = hit.reflectivity * (kRoughness + (1.0 - kRoughness) * hit.incidence_cosine) * spread * spread;
  const double ratio = strength / kThreshold;
  const double fourth = ratio * ratio * ratio * ratio;
  return random.chance(fourth / (1.0 + fourth));
}

Lidar lidar(std::string_view name)
{
  for (const Specification& entry : kSpecifications) {
    if (name == entry.name) {
      const SensorModel model = sensorModel(name);
      Lidar result{entry.name,      {model.elevations.begin(), model.elevations.end()},
                   entry.columns,   entry.min_range,
                   entry.max_range, ScanPattern::turning};
      if (entry.top_first) {
        std::reverse(result.elevations.begin(), result.elevations.end());
      }
      return result;
    }
  }
  for (const SolidState& entry : kSolidState) {
    if (name == entry.name) {
      return {entry.name,      std::vector<double>(static_cast<std::size_t>(entry.lasers)),
              entry.columns,   entry.min_range,
              entry.max_range, entry.pattern};
    }
  }
  throw std::invalid_argument("unknown sensor '" + std::string(name) + "'");
}

const std::vector<std::string>& lidarNames()
{
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Specification& entry : kSpecifications) {
      list.emplace_back(entry.name);
    }
    for (const SolidState& entry : kSolidState) {
      list.emplace_back(entry.name);
    }
    return list;
  }();
  return names;
}

}  // namespace pcl_floam::simulator
