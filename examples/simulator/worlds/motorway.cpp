#include "../objects.h"
#include "../roadside.h"
#include "../world.h"
#include "road.h"
#include "verge.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kMotorwayLane = 3.75;    // m, width of a lane; the sensor drives in the rightmost one
constexpr double kMotorwayReach = 110.0;  // m of ground to each side of the way
constexpr double kRailClear = 2.5;        // m that rails and their posts keep from the way

/// What the generator draws from; as it stands, for \ref Family::tune.
struct MotorwayRanges {
  Interval right_rail{4.0, 9.0};  ///< m from the sensor's lane
  double right_rail_chance = 0.5;
  int lanes = 2;                      ///< at most, in the sensor's direction: ramps have fewer than the motorway
  double concrete = 0.2;              ///< of the barriers; the others are steel rails
  Interval hard_shoulder{1.0, 3.0};   ///< m to the right of the sensor's lane
  Interval median{1.5, 4.0};          ///< m between the two directions
  double median_bushes = 0.5;         ///< chance that bushes grow there
  Interval bush_gap{2.0, 6.0};        ///< m along the road
  Interval bush_aside{9.0, 30.0};     ///< m from the sensor's lane
  Interval tree_gap{5.0, 20.0};       ///< m
  Interval tree_aside{10.0, 60.0};    ///< m
  Interval sign_gap{80.0, 200.0};     ///< m
  Interval gantry_gap{250.0, 600.0};  ///< m
  Interval post_gap{40.0, 60.0};      ///< m
  Interval car_gap{50.0, 150.0};      ///< m, in each lane
  VergeRanges verge;
};

VergeRanges vergeRangesOf(Family family)
{
  VergeRanges ranges;
  if (family != Family::tune) {
    const bool report = family == Family::report;
    ranges.level = report ? Interval{0.5, 10.0} : Interval{1.0, 8.0};
    ranges.ditch = report ? Interval{0.1, 1.0} : Interval{0.1, 0.8};
    ranges.bank = report ? Interval{-1.0, 5.0} : Interval{-0.5, 4.0};
    ranges.slope = report ? Interval{4.0, 25.0} : Interval{4.0, 20.0};
    ranges.rough = report ? Interval{0.02, 0.15} : Interval{0.02, 0.12};
    ranges.grass = report ? Interval{0.05, 0.6} : Interval{0.05, 0.5};
    ranges.tufts = report ? Interval{0.2, 3.0} : Interval{0.3, 2.5};
    ranges.belt_chance = report ? 0.95 : 0.96;
    ranges.belt = report ? Interval{1.0, 18.0} : Interval{1.0, 14.0};
    ranges.belt_depth = report ? Interval{5.0, 35.0} : Interval{5.0, 25.0};
    ranges.cover = report ? Interval{0.5, 3.0} : Interval{0.6, 2.5};
    ranges.height = report ? Interval{1.2, 8.0} : Interval{1.3, 6.0};
  }
  return ranges;
}

MotorwayRanges motorwayRangesOf(Family family)
{
  MotorwayRanges ranges;
  ranges.verge = vergeRangesOf(family);
  if (family != Family::tune) {
    const bool report = family == Family::report;
    ranges.right_rail = report ? Interval{3.5, 12.0} : Interval{3.5, 9.0};
    ranges.right_rail_chance = report ? 0.5 : 0.6;
    ranges.lanes = 3;
    ranges.concrete = report ? 0.35 : 0.3;
    ranges.hard_shoulder = report ? Interval{0.5, 4.0} : Interval{0.5, 3.5};
    ranges.gantry_gap = report ? Interval{200.0, 1500.0} : Interval{200.0, 1000.0};
    ranges.median = report ? Interval{1.0, 14.0} : Interval{1.0, 8.0};
    ranges.median_bushes = 0.5;
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

/// Where the lanes of both directions lie; m to the left of the sensor's lane.
struct Carriageways {
  int lanes;
  double median, hard_shoulder;

  [[nodiscard]] double rightEdge() const { return -0.5 * kMotorwayLane - hard_shoulder; }
  /// Of the strip between the directions.
  [[nodiscard]] double middle() const { return (lanes - 0.5) * kMotorwayLane + 0.5 * median; }
  [[nodiscard]] double leftEdge() const { return middle() + 0.5 * median + 2.0 * kMotorwayLane; }
};

/// A steel rail on posts, or a wall of concrete that is wide at its foot.
void addBarrier(TriangleMesh& mesh, Random& random, const Way& way, double left, double concrete)
{
  const StripExtent all{0.0, way.line.length(), 2.0};
  if (random.chance(concrete)) {
    addStrip(mesh, random, way.line, way.terrain, all,
             {{left - 0.3, 0.0},
              {left - 0.13, 0.3},
              {left - 0.08, 0.85},
              {left + 0.08, 0.85},
              {left + 0.13, 0.3},
              {left + 0.3, 0.0}},
             0.0, 0.4);
    return;
  }
  addStrip(mesh, random, way.line, way.terrain, all, {{left, 0.45}, {left + 0.06, 0.6}, {left, 0.75}}, 0.0, 0.6);
  // Posts stand twice as close where the rail must not give way.
  const double between = random.chance(0.5) ? 2.0 : 4.0;
  for (double station = 0.0; station < all.to; station += between) {
    addBox(mesh, besideWay(way, station, left), {0.1, 0.12, 0.7}, 0.5);
  }
}

/// A place beside both directions, clear of the whole way.
bool drawPlace(const Way& way, Random& random, double station, const Interval& aside, const Carriageways& lanes,
               SE3& place)
{
  const double distance = aside.draw(random);
  const double left = random.chance(0.5) ? lanes.leftEdge() + distance - 0.5 * kMotorwayLane : -distance;
  place = besideWay(way, station, left, M_PI);
  return isClear(way, place.translation.head<2>(), std::min(distance, 8.0) - 0.5);
}

void addMedianBushes(TriangleMesh& mesh, Random& random, const Way& way, const Carriageways& lanes)
{
  const double wide = std::min(1.2, 0.4 * lanes.median);
  const double half = 0.5 * random.uniform(0.8, 2.0);
  for (double s = 0.0; s < way.line.length(); s += wide * random.uniform(0.8, 2.5)) {
    const double aside = std::max(0.5 * lanes.median - wide, 0.5) * random.uniform(-1.0, 1.0);
    const SE3 foot = besideWay(way, s, lanes.middle() + aside) * upright(0.0, 0.0, 0.9 * half);
    addFoliage(mesh, random, foot, {wide, wide, half}, 0.15, 150, 0.4);
  }
}

void addPlants(TriangleMesh& mesh, Random& random, const MotorwayRanges& ranges, const Way& way,
               const Carriageways& lanes)
{
  SE3 place;
  const double bush_gap = ranges.bush_gap.draw(random);
  for (double s = 0.0; s < way.line.length(); s += bush_gap * random.uniform(0.3, 1.7)) {
    if (drawPlace(way, random, s, ranges.bush_aside, lanes, place)) {
      const Eigen::Vector3d radii(random.uniform(0.5, 1.8), random.uniform(0.5, 1.8), random.uniform(0.5, 1.4));
      addFoliage(mesh, random, place * upright(0.0, 0.0, 0.7 * radii.z()), radii, 0.12, 160, 0.4);
    }
  }
  const double tree_gap = ranges.tree_gap.draw(random);
  for (double s = 0.0; s < way.line.length(); s += tree_gap * random.uniform(0.3, 1.7)) {
    if (drawPlace(way, random, s, ranges.tree_aside, lanes, place)) {
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

/// Signs over the road.
void addGantries(TriangleMesh& mesh, Random& random, const MotorwayRanges& ranges, const Way& way,
                 const Carriageways& lanes)
{
  const double right = lanes.rightEdge() - 1.5;
  const double left = lanes.middle();
  for (double s = ranges.gantry_gap.draw(random) * random.uniform(); s < way.line.length();
       s += ranges.gantry_gap.draw(random)) {
    for (const double foot : {right, left}) {
      addBox(mesh, besideWay(way, s, foot), {0.4, 0.4, 7.0}, 0.5);
    }
    const SE3 over = besideWay(way, s, 0.5 * (right + left));
    addBox(mesh, over * upright(0.0, 0.0, 6.2), {0.5, left - right, 0.8}, 0.5);
    addBox(mesh, over * upright(-0.4, 0.0, 5.6), {0.1, 0.5 * (left - right), 2.2}, 0.9);
  }
}

void addTraffic(World& world, Random& random, const MotorwayRanges& ranges, const Way& way, const Carriageways& lanes)
{
  const PathLine back = reversed(way.line);
  for (const double outer : {0.5, 1.5}) {
    const double other = -(lanes.leftEdge() - outer * kMotorwayLane);
    for (double s = 10.0; s < back.length() - 60.0; s += ranges.car_gap.draw(random)) {
      addVehicle(world, random, back, way.terrain, cruising(random.uniform(22.0, 33.0), other, s), 0.15);
    }
  }
  for (int lane = 0; lane < lanes.lanes; ++lane) {
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
  const Carriageways lanes{1 + random.index(ranges.lanes), ranges.median.draw(random),
                           ranges.hard_shoulder.draw(random)};
  const Verge right(ranges.verge, lanes.rightEdge(), random);
  const Verge left(ranges.verge, lanes.leftEdge(), random);
  const auto section = [&](double along, double aside) { return (aside < 0.0 ? right : left).height(along, aside); };
  const Way way = makeWay(options, {25.0, 200.0, 0.15, 2.0, kMotorwayReach}, random, section);
  World world;
  world.default_sensor = "hdl64";
  world.sensor_motion = way.motion;
  world.acceleration = way.motion.accelerationBound();
  addGroundAlong(world.still, way, 0.2);
  addBarrier(world.still, random, way, lanes.middle(), ranges.concrete);
  const double right_rail = ranges.right_rail.draw(random);
  if (random.chance(ranges.right_rail_chance)) {
    addBarrier(world.still, random, way, -right_rail, ranges.concrete);
  }
  right.plant(world.still, random, way);
  left.plant(world.still, random, way);
  if (random.chance(ranges.median_bushes)) {
    addMedianBushes(world.still, random, way, lanes);
  }
  addPlants(world.still, random, ranges, way, lanes);
  addPostsAndSigns(world.still, random, ranges, way);
  addGantries(world.still, random, ranges, way, lanes);
  addTraffic(world, random, ranges, way, lanes);
  return world;
}

}  // namespace pcl_floam::simulator
