#include "../objects.h"
#include "../roadside.h"
#include "../world.h"
#include "road.h"
#include "way.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kTownLane = 3.3;    // m, width of a lane; the sensor drives in the right one of two
constexpr double kDepth = 11.0;      // m of a house behind its front that must be clear of the way
constexpr double kTownReach = 70.0;  // m of ground to each side of the way
constexpr double kHouseClear = 7.0;  // m from the way to the nearest wall
constexpr double kCarClear = 2.4;    // m from the way to the middle of a parked car

/// What the generator draws from; as it stands, for \ref Family::tune.
struct TownRanges {
  Interval front{8.0, 11.0};       ///< m from the middle of the street to the houses
  Interval width{8.0, 20.0};       ///< m, of a house
  double gap = 0.2;                ///< chance of a gap beside a house
  Interval gap_width{2.0, 8.0};    ///< m
  Interval crossing{80.0, 180.0};  ///< m from one side street to the next
  Interval tree_gap{10.0, 25.0};   ///< m
  Interval lamp_gap{25.0, 40.0};   ///< m
  double parked = 0.5;             ///< chance that a place beside the kerb is taken
  Interval oncoming{40.0, 120.0};  ///< m from one car to the next
};

TownRanges townRangesOf(Family family)
{
  TownRanges ranges;
  if (family != Family::tune) {
    const bool report = family == Family::report;
    ranges.front = report ? Interval{7.5, 18.0} : Interval{8.0, 15.0};
    ranges.width = report ? Interval{6.0, 30.0} : Interval{7.0, 25.0};
    ranges.gap = report ? 0.5 : 0.35;
    ranges.gap_width = report ? Interval{1.0, 25.0} : Interval{1.0, 15.0};
    ranges.crossing = report ? Interval{50.0, 250.0} : Interval{60.0, 220.0};
    ranges.tree_gap = report ? Interval{6.0, 60.0} : Interval{8.0, 40.0};
    ranges.lamp_gap = report ? Interval{18.0, 60.0} : Interval{20.0, 50.0};
    ranges.parked = report ? 0.35 : 0.4;
    ranges.oncoming = report ? Interval{25.0, 250.0} : Interval{30.0, 180.0};
  }
  return ranges;
}

/// Whether the front of a house and what lies behind it keep clear of the way.
bool hasRoom(const Way& way, const SE3& world_T_front, double width)
{
  for (double x = 0.0; x <= width; x += 2.0) {
    for (double y = 0.0; y >= -kDepth; y -= 2.75) {
      const Eigen::Vector3d place = world_T_front * Eigen::Vector3d(x, y, 0.0);
      if (!isClear(way, place.head<2>(), kHouseClear)) {
        return false;
      }
    }
  }
  return true;
}

/// Houses along one side; a facade looks at the street.
/// \param side 1: left, -1: right
void addHouses(TriangleMesh& mesh, Random& random, const TownRanges& ranges, const Way& way, double side)
{
  const double front = ranges.front.draw(random);
  double next_crossing = ranges.crossing.draw(random);
  for (double station = 0.0; station < way.line.length();) {
    const double width = ranges.width.draw(random);
    const double left = 0.5 * kTownLane + side * (front + random.uniform(0.0, 0.8));
    // At the left a facade begins at its far end and turns back.
    const SE3 place = besideWay(way, side > 0.0 ? station + width : station, left, side > 0.0 ? M_PI : 0.0);
    if (hasRoom(way, place, width)) {
      addHouse(mesh, random, place, width);
    }
    station += width + (random.chance(ranges.gap) ? ranges.gap_width.draw(random) : 0.0);
    if (station > next_crossing) {
      station += random.uniform(8.0, 14.0);
      next_crossing = station + ranges.crossing.draw(random);
    }
  }
}

/// Kerbs, and what stands on the pavements.
void addFurnitureAlong(TriangleMesh& mesh, Random& random, const TownRanges& ranges, const Way& way, double side)
{
  const double kerb = 0.5 * kTownLane + side * (kTownLane + 2.1);
  addStrip(mesh, random, way.line, way.terrain, {0.0, way.line.length(), 2.0},
           {{kerb, -0.05}, {kerb, 0.12}, {kerb + side * 2.0, 0.12}}, 0.0, 0.3);
  const auto clear = [&way](const SE3& place, double distance) {
    return isClear(way, place.translation.head<2>(), distance);
  };
  const double tree_gap = ranges.tree_gap.draw(random);
  for (double s = tree_gap * random.uniform(); s < way.line.length(); s += tree_gap * random.uniform(0.7, 1.6)) {
    if (const SE3 place = besideWay(way, s, kerb + side * 0.8); clear(place, 3.0)) {
      addTree(mesh, random, place);
    }
  }
  const double lamp_gap = ranges.lamp_gap.draw(random);
  for (double s = lamp_gap * random.uniform(); s < way.line.length(); s += lamp_gap) {
    if (const SE3 place = besideWay(way, s, kerb + side * 0.5, -side * 0.5 * M_PI); clear(place, 3.0)) {
      addLamp(mesh, place, random.uniform(5.0, 8.0));
    }
    if (const SE3 place = besideWay(way, s + 7.0, kerb + side * 0.4, M_PI); random.chance(0.5) && clear(place, 3.0)) {
      addSign(mesh, random, place);
    }
  }
  for (double s = 3.0; s < way.line.length(); s += random.uniform(5.3, 6.3)) {
    const SE3 place = besideWay(way, s, kerb - side * random.uniform(1.0, 1.2), random.uniform(-0.04, 0.04));
    if (random.chance(ranges.parked) && clear(place, kCarClear)) {
      addCar(mesh, random, place);
    }
  }
}

void addTraffic(World& world, Random& random, const TownRanges& ranges, const Way& way)
{
  const PathLine back = reversed(way.line);
  for (double station = 20.0; station < back.length() - 40.0; station += ranges.oncoming.draw(random)) {
    DriveStyle style;
    style.speed = random.uniform(7.0, 13.0);
    style.start_speed = 5.0;
    style.acceleration = 1.5;
    style.side_acceleration = 2.2;
    style.left = -kTownLane;
    style.first_station = station;
    addVehicle(world, random, back, way.terrain, style, 0.05);
  }
}

}  // namespace

World makeTown(const WorldOptions& options)
{
  Random random = randomOfWorld(options, 9);
  const TownRanges ranges = townRangesOf(options.family);
  const Way way = makeWay(options, {11.0, 90.0, 1.4, 1.5, kTownReach}, random);
  World world;
  world.default_sensor = "hdl64";
  world.sensor_motion = way.motion;
  world.acceleration = way.motion.accelerationBound();
  addGroundAlong(world.still, way, 0.2);
  for (const double side : {-1.0, 1.0}) {
    addHouses(world.still, random, ranges, way, side);
    addFurnitureAlong(world.still, random, ranges, way, side);
  }
  addTraffic(world, random, ranges, way);
  return world;
}

}  // namespace pcl_floam::simulator
