// Cars and people do not stay in the map where they no longer are.
#include "simulator/test_world.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace pcl_floam::simulator {
namespace {

/// Places where something was seen, to a voxel's size.
class Places {
public:
  void add(const Eigen::Vector3d& point) { keys_.insert(keyOf(point, 0, 0, 0)); }

  [[nodiscard]] bool holdsNear(const Eigen::Vector3d& point) const
  {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (keys_.count(keyOf(point, dx, dy, dz)) > 0) {
            return true;
          }
        }
      }
    }
    return false;
  }

private:
  using Key = std::tuple<int, int, int>;

  static Key keyOf(const Eigen::Vector3d& point, int dx, int dy, int dz)
  {
    constexpr double kSize = 0.3;  // m
    return {static_cast<int>(std::floor(point.x() / kSize)) + dx, static_cast<int>(std::floor(point.y() / kSize)) + dy,
            static_cast<int>(std::floor(point.z() / kSize)) + dz};
  }

  std::set<Key> keys_;
};

struct MapPoints {
  std::size_t of_what_stands = 0;
  std::size_t of_what_has_gone = 0;
};

/// The map's points after the drive, by what was seen there.
MapPoints mapPoints(const Odometry<PointXYZIRT>& odometry, const Places& standing, const Places& moved)
{
  MapPoints points;
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    for (const Eigen::Vector3d& point : odometry.map().points(kind)) {
      if (standing.holdsNear(point)) {
        ++points.of_what_stands;
      } else if (moved.holdsNear(point)) {
        ++points.of_what_has_gone;
      }
    }
  }
  return points;
}

}  // namespace

struct DriveAmongObjects {
  const char* world;
  const char* sensor;
  double start;
  std::size_t scans;
  double gone;  ///< share of the points of moving objects that may remain; some are there still
};

class MovingObjects : public testing::TestWithParam<DriveAmongObjects> {};

INSTANTIATE_TEST_SUITE_P(Worlds, MovingObjects,
                         testing::Values(DriveAmongObjects{"urban", "hdl64", 5.0, 100, 0.4},
                                         DriveAmongObjects{"urban", "vlp16", 5.0, 200, 0.6},
                                         DriveAmongObjects{"warehouse", "vlp16", 0.0, 300, 0.6},
                                         DriveAmongObjects{"urban", "hap", 5.0, 100, 0.4},
                                         DriveAmongObjects{"warehouse", "mid360", 0.0, 300, 0.6}),
                         [](const auto& parameter) {
                           return std::string(parameter.param.world) + "_" + parameter.param.sensor;
                         });

TEST_P(MovingObjects, LeaveTheMapWhereTheyNoLongerAre)
{
  SimulationOptions options = testWorld(GetParam().world, GetParam().sensor);
  options.seed = 21;
  options.start = GetParam().start;
  Simulation simulation(options);
  OdometryParameters parameters;
  Odometry<PointXYZIRT> forgetting(parameters);
  parameters.map.see_through_range = 0.0;
  Odometry<PointXYZIRT> keeping(parameters);
  Places standing;
  Places moved;
  SE3 first_T_world;
  for (std::size_t number = 0; number < GetParam().scans; ++number) {
    const Sweep sweep = simulation.sweep(number);
    if (number == 0) {
      first_T_world = sweep.world_T_end.inverse();
    }
    const SE3 first_T_end = first_T_world * sweep.world_T_end;
    for (std::size_t i = 0; i < sweep.exact_at_end.size(); ++i) {
      (sweep.moving[i] != 0 ? moved : standing).add(first_T_end * sweep.exact_at_end[i].cast<double>());
    }
    forgetting.track(sweep.cloud, sweep.end_time);
    keeping.track(sweep.cloud, sweep.end_time);
  }
  const MapPoints usual = mapPoints(forgetting, standing, moved);
  const MapPoints all = mapPoints(keeping, standing, moved);
  const auto percentOf = [](std::size_t left, std::size_t of) {
    return std::to_string(100.0 * static_cast<double>(left) / static_cast<double>(of));
  };
  RecordProperty("percent_left_of_what_has_gone", percentOf(usual.of_what_has_gone, all.of_what_has_gone));
  RecordProperty("percent_left_of_what_stands", percentOf(usual.of_what_stands, all.of_what_stands));
  EXPECT_GT(all.of_what_has_gone, 100U);
  EXPECT_LT(static_cast<double>(usual.of_what_has_gone), GetParam().gone * static_cast<double>(all.of_what_has_gone));
  EXPECT_GT(static_cast<double>(usual.of_what_stands), 0.995 * static_cast<double>(all.of_what_stands));
}

}  // namespace pcl_floam::simulator
