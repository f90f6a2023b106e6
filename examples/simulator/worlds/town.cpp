#include "../objects.h"
#include "../roadside.h"
#include "../world.h"
#include "road.h"
#include "verge.h"

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
  Interval kerb{5.0, 6.5};         ///< m from the middle of the street to its kerbs
  Interval front{2.5, 5.0};        ///< m from the kerb to the houses
  double fence = 0.5;              ///< of the front gardens have a hedge, a wall or a fence
  Interval width{8.0, 20.0};       ///< m, of a house
  double gap = 0.2;                ///< chance of a gap beside a house
  Interval gap_width{2.0, 8.0};    ///< m
  Interval crossing{80.0, 180.0};  ///< m from one side street to the next
  Interval tree_gap{10.0, 25.0};   ///< m
  Interval lamp_gap{25.0, 40.0};   ///< m
  Interval parked{0.2, 0.7};       ///< chance that a place beside a kerb is taken
  Interval oncoming{40.0, 120.0};  ///< m from one car to the next
  VergeRanges garden;              ///< what lies beyond the kerbs
};

VergeRanges gardenRangesOf(Family family)
{
  const bool tune = family == Family::tune;
  const bool report = family == Family::report;
  VergeRanges ranges;
  ranges.paved = 2.0;
  ranges.level = {2.0, 3.0};
  ranges.ditch_chance = 0.0;
  ranges.bank = tune ? Interval{-0.2, 0.6} : (report ? Interval{-0.5, 1.5} : Interval{-0.4, 1.2});
  ranges.slope = {4.0, 12.0};
  ranges.rough = {0.01, report ? 0.08 : 0.05};
  ranges.grass = {0.03, report ? 0.3 : 0.2};
  ranges.tufts = tune ? Interval{0.2, 1.0} : (report ? Interval{0.1, 2.0} : Interval{0.1, 1.5});
  ranges.belt_chance = 0.8;
  ranges.belt = {2.5, report ? 8.0 : 5.0};
  ranges.belt_depth = {2.0, report ? 15.0 : 8.0};
  ranges.cover = {0.05, report ? 0.6 : 0.4};
  ranges.height = {0.8, report ? 4.0 : 2.5};
  return ranges;
}

TownRanges townRangesOf(Family family)
{
  TownRanges ranges;
  ranges.garden = gardenRangesOf(family);
  if (family != Family::tune) {
    const bool report = family == Family::report;
    ranges.kerb = report ? Interval{4.6, 10.0} : Interval{4.8, 8.0};
    ranges.front = report ? Interval{2.0, 12.0} : Interval{2.0, 8.0};
    ranges.fence = report ? 0.7 : 0.6;
    ranges.width = report ? Interval{6.0, 30.0} : Interval{7.0, 25.0};
    ranges.gap = report ? 0.5 : 0.35;
    ranges.gap_width = report ? Interval{1.0, 25.0} : Interval{1.0, 15.0};
    ranges.crossing = report ? Interval{50.0, 250.0} : Interval{60.0, 220.0};
    ranges.tree_gap = report ? Interval{6.0, 60.0} : Interval{8.0, 40.0};
    ranges.lamp_gap = report ? Interval{18.0, 60.0} : Interval{20.0, 50.0};
    ranges.parked = report ? Interval{0.0, 0.7} : Interval{0.1, 0.7};
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
void addHouses(TriangleMesh& mesh, Random& random, const TownRanges& ranges, const Way& way, double side, double front)
{
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

/// A low wall, or rails on posts.
void addFence(TriangleMesh& mesh, Random& random, const Way& way, const StripExtent& extent, double left)
{
  const double height = random.uniform(0.6, 1.5);
  if (random.chance(0.5)) {
    addStrip(mesh, random, way.line, way.terrain, extent,
             {{left - 0.1, -0.2}, {left - 0.1, height}, {left + 0.1, height}, {left + 0.1, -0.2}}, 0.0, 0.4);
    return;
  }
  for (const double rail : {0.35 * height, height}) {
    addStrip(mesh, random, way.line, way.terrain, extent, {{left, rail - 0.1}, {left, rail}}, 0.0, 0.4);
  }
  for (double station = extent.from; station <= extent.to; station += extent.step) {
    addBox(mesh, besideWay(way, station, left), {0.08, 0.08, height}, 0.4);
  }
}

void addHedge(TriangleMesh& mesh, Random& random, const Way& way, const StripExtent& extent, double left)
{
  const double half = 0.5 * random.uniform(0.7, 2.0);
  for (double station = extent.from; station <= extent.to; station += 0.8) {
    const SE3 foot = besideWay(way, station, left) * upright(0.0, 0.0, half);
    addFoliage(mesh, random, foot, {0.8, 0.4, half}, 0.1, 150, 0.4);
  }
}

/// What parts the front gardens from the pavement, stretch by stretch.
void addFences(TriangleMesh& mesh, Random& random, const TownRanges& ranges, const Way& way, double left)
{
  for (double from = random.uniform(0.0, 10.0); from < way.line.length();) {
    const StripExtent extent{from, from + random.uniform(6.0, 25.0), 2.0};
    const SE3 middle = besideWay(way, 0.5 * (extent.from + extent.to), left);
    if (random.chance(ranges.fence) && isClear(way, middle.translation.head<2>(), 3.0)) {
      random.chance(0.5) ? addHedge(mesh, random, way, extent, left) : addFence(mesh, random, way, extent, left);
    }
    from = extent.to + random.uniform(1.0, 5.0);
  }
}

/// Kerbs, and what stands on the pavements.
void addFurnitureAlong(TriangleMesh& mesh, Random& random, const TownRanges& ranges, const Way& way, double side,
                       double kerb)
{
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
}

void addParkedCars(TriangleMesh& mesh, Random& random, const TownRanges& ranges, const Way& way, double side,
                   double kerb)
{
  const double parked = ranges.parked.draw(random);
  for (double s = 3.0; s < way.line.length(); s += random.uniform(5.3, 6.3)) {
    const SE3 place = besideWay(way, s, kerb - side * random.uniform(1.0, 1.2), random.uniform(-0.04, 0.04));
    if (random.chance(parked) && isClear(way, place.translation.head<2>(), kCarClear)) {
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
  const double middle = 0.5 * kTownLane;
  const double kerb = ranges.kerb.draw(random);
  const Verge right(ranges.garden, middle - kerb, random);
  const Verge left(ranges.garden, middle + kerb, random);
  const auto section = [&](double along, double aside) { return (aside < 0.0 ? right : left).height(along, aside); };
  const Way way = makeWay(options, {11.0, 90.0, 1.4, 1.5, kTownReach}, random, section);
  World world;
  world.default_sensor = "hdl64";
  world.sensor_motion = way.motion;
  world.acceleration = way.motion.accelerationBound();
  addGroundAlong(world.still, way, 0.2);
  for (const double side : {-1.0, 1.0}) {
    const double front = kerb + ranges.front.draw(random);
    addHouses(world.still, random, ranges, way, side, front);
    addFurnitureAlong(world.still, random, ranges, way, side, middle + side * kerb);
    addParkedCars(world.still, random, ranges, way, side, middle + side * kerb);
    addFences(world.still, random, ranges, way, middle + side * (kerb + 2.1));
    (side < 0.0 ? right : left).plant(world.still, random, way);
  }
  addTraffic(world, random, ranges, way);
  return world;
}

}  // namespace pcl_floam::simulator
