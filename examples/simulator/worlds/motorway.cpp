#include "../objects.h"
#include "../roadside.h"
#include "../world.h"
#include "road.h"
#include "way.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kMotorwayLane = 3.75;    // m, width of a lane; the sensor drives in the right one of two
constexpr double kMotorwayReach = 110.0;  // m of ground to each side of the way
constexpr double kRailClear = 2.5;        // m that rails and their posts keep from the way

/// What the generator draws from; as it stands, for \ref Family::tune.
struct MotorwayRanges {
  Interval right_rail{4.0, 7.0};  ///< m from the sensor's lane
  double right_rail_chance = 0.7;
  Interval median{1.5, 4.0};        ///< m between the two directions
  Interval bush_gap{2.0, 6.0};      ///< m along the road
  Interval bush_aside{9.0, 30.0};   ///< m from the sensor's lane
  Interval tree_gap{5.0, 20.0};     ///< m
  Interval tree_aside{10.0, 60.0};  ///< m
  Interval sign_gap{80.0, 200.0};   ///< m
  Interval post_gap{40.0, 60.0};    ///< m
  Interval car_gap{50.0, 150.0};    ///< m, in each lane
};

MotorwayRanges motorwayRangesOf(Family family)
{
  MotorwayRanges ranges;
  if (family != Family::tune) {
    const bool report = family == Family::report;
    ranges.right_rail = report ? Interval{3.5, 12.0} : Interval{3.5, 9.0};
    ranges.right_rail_chance = report ? 0.5 : 0.6;
    ranges.median = report ? Interval{1.0, 14.0} : Interval{1.0, 8.0};
    ranges.bush_gap = report ? Interval{2.0, 15.0} : Interval{2.0, 10.0};
    ranges.bush_aside = report ? Interval{8.0, 50.0} : Interval{8.0, 40.0};
    ranges.tree_gap = report ? Interval{4.0, 40.0} : Interval{5.0, 30.0};
    ranges.tree_aside = report ? Interval{9.0, 90.0} : Interval{10.0, 75.0};
    ranges.sign_gap = report ? Interval{60.0, 500.0} : Interval{70.0, 350.0};
    ranges.post_gap = report ? Interval{25.0, 100.0} : Interval{33.0, 80.0};
    ranges.car_gap = report ? Interval{30.0, 300.0} : Interval{40.0, 200.0};
  }
  return ranges;
}

void addRail(TriangleMesh& mesh, Random& random, const Way& way, double left)
{
  addStrip(mesh, random, way.line, way.terrain, {0.0, way.line.length(), 2.0},
           {{left, 0.45}, {left + 0.06, 0.6}, {left, 0.75}}, 0.0, 0.6);
  for (double station = 0.0; station < way.line.length(); station += 4.0) {
    addBox(mesh, besideWay(way, station, left), {0.1, 0.08, 0.7}, 0.5);
  }
}

/// m to the left of the sensor's lane that the other direction's outer lane ends at.
double otherEdge(double median)
{
  return 1.5 * kMotorwayLane + median + 2.0 * kMotorwayLane;
}

/// A place beside both directions, clear of the whole way.
bool drawPlace(const Way& way, Random& random, double station, const Interval& aside, double median, SE3& place)
{
  const double distance = aside.draw(random);
  const double left = random.chance(0.5) ? otherEdge(median) + distance - 0.5 * kMotorwayLane : -distance;
  place = besideWay(way, station, left, M_PI);
  return isClear(way, place.translation.head<2>(), std::min(distance, 8.0) - 0.5);
}

void addPlants(TriangleMesh& mesh, Random& random, const MotorwayRanges& ranges, const Way& way, double median)
{
  SE3 place;
  const double bush_gap = ranges.bush_gap.draw(random);
  for (double s = 0.0; s < way.line.length(); s += bush_gap * random.uniform(0.3, 1.7)) {
    if (drawPlace(way, random, s, ranges.bush_aside, median, place)) {
      const Eigen::Vector3d radii(random.uniform(0.5, 1.8), random.uniform(0.5, 1.8), random.uniform(0.5, 1.4));
      addFoliage(mesh, random, place * upright(0.0, 0.0, 0.7 * radii.z()), radii, 0.12, 160, 0.4);
    }
  }
  const double tree_gap = ranges.tree_gap.draw(random);
  for (double s = 0.0; s < way.line.length(); s += tree_gap * random.uniform(0.3, 1.7)) {
    if (drawPlace(way, random, s, ranges.tree_aside, median, place)) {
      addTree(mesh, random, place);
    }
  }
}

void addPostsAndSigns(TriangleMesh& mesh, Random& random, const MotorwayRanges& ranges, const Way& way)
{
  const double post_gap = ranges.post_gap.draw(random);
  for (double s = 0.0; s < way.line.length(); s += post_gap) {
    if (const SE3 place = besideWay(way, s, -3.2); isClear(way, place.translation.head<2>(), kRailClear)) {
      addBox(mesh, place, {0.08, 0.12, 1.05}, 0.9);
    }
  }
  for (double s = 30.0; s < way.line.length(); s += ranges.sign_gap.draw(random)) {
    if (const SE3 place = besideWay(way, s, -random.uniform(5.0, 8.0), M_PI);
        isClear(way, place.translation.head<2>(), kRailClear)) {
      addSign(mesh, random, place);
    }
  }
}

void addTraffic(World& world, Random& random, const MotorwayRanges& ranges, const Way& way, double median)
{
  const PathLine back = reversed(way.line);
  for (int lane = 0; lane < 2; ++lane) {
    const double other = -(2.0 * kMotorwayLane + median) + (lane == 0 ? 0.0 : -kMotorwayLane);
    for (double s = 10.0; s < back.length() - 60.0; s += ranges.car_gap.draw(random)) {
      addVehicle(world, random, back, way.terrain, cruising(random.uniform(22.0, 33.0), other, s), 0.15);
    }
    for (double s = 10.0; s < 200.0 && s < way.line.length() - 60.0; s += ranges.car_gap.draw(random)) {
      addVehicle(world, random, way.line, way.terrain, cruising(random.uniform(20.0, 30.0), lane * kMotorwayLane, s),
                 0.15);
    }
  }
}

}  // namespace

World makeMotorway(const WorldOptions& options)
{
  Random random = randomOfWorld(options, 10);
  const MotorwayRanges ranges = motorwayRangesOf(options.family);
  const Way way = makeWay(options, {25.0, 200.0, 0.15, 2.0, kMotorwayReach}, random);
  World world;
  world.default_sensor = "hdl64";
  world.sensor_motion = way.motion;
  world.acceleration = way.motion.accelerationBound();
  addGroundAlong(world.still, way, 0.2);
  const double median = ranges.median.draw(random);
  addRail(world.still, random, way, 1.5 * kMotorwayLane + 0.5 * median);
  const double right_rail = ranges.right_rail.draw(random);
  if (random.chance(ranges.right_rail_chance)) {
    addRail(world.still, random, way, -right_rail);
  }
  addPlants(world.still, random, ranges, way, median);
  addPostsAndSigns(world.still, random, ranges, way);
  addTraffic(world, random, ranges, way, median);
  return world;
}

}  // namespace pcl_floam::simulator
