#include "../objects.h"
#include "../roadside.h"
#include "../world.h"
#include "road.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam::simulator {

namespace {

constexpr double kOpenRoadStart = 200.0;  // m along the road where the sensor starts: it sees as much road behind
constexpr double kOpenRoadWay = 950.0;    // m to go
constexpr double kRoadLength = 1350.0;    // m
constexpr double kLaneWidth = 3.6;        // m
constexpr double kAcceleration = 2.0;     // m/s^2, a brisk car
constexpr double kStanding = 0.6;         // s at rest before it moves: so long takes rounding the jerk off
constexpr double kRailAtTheLeft = 0.25;   // of the rails: beyond the lanes of the other direction
constexpr double kSeen = 160.0;           // m to each side of the road that there is ground

/// What the generator draws from; as it stands, for \ref Family::tune.
struct OpenRoadRanges {
  Interval rolling{0.5, 1.5};         ///< m, standard deviation of the ground's height in hills
  Interval hills{150.0, 500.0};       ///< m, their wavelengths
  Interval unevenness{0.002, 0.008};  ///< m, standard deviation of the ground's height in bumps a few metres long
  Interval bends{5.0, 25.0};          ///< m, standard deviation of the road to both sides of straight
  Interval speed{23.0, 27.0};         ///< m/s
  double rail_chance = 0.8;           ///< that there is a rail
  Interval rail{8.0, 11.0};           ///< m, from the sensor's lane to the rail
  Interval pole_gap{18.0, 40.0};      ///< m along the road from pole to pole
  Interval tree_gap{4.0, 11.0};       ///< m along the road from tree to tree
  Interval house_gap{30.0, 90.0};     ///< m along the road from house to house
  Interval pole_aside{13.0, 20.0};    ///< m from the road's middle
  Interval aside{16.0, 150.0};        ///< m from the road's middle, of trees and houses
  Interval cars{12.0, 20.0};          ///< number of vehicles
  Interval car_speed{21.0, 30.0};     ///< m/s
  double lorries = 0.1;               ///< of the vehicles
};

OpenRoadRanges openRoadRangesOf(Family family)
{
  OpenRoadRanges ranges;
  if (family != Family::tune) {
    const bool report = family == Family::report;
    ranges.rolling = report ? Interval{0.3, 2.5} : Interval{0.4, 2.0};
    ranges.hills = report ? Interval{120.0, 700.0} : Interval{130.0, 600.0};
    ranges.unevenness = report ? Interval{0.001, 0.012} : Interval{0.002, 0.010};
    ranges.bends = report ? Interval{0.0, 35.0} : Interval{2.0, 30.0};
    ranges.speed = report ? Interval{19.0, 33.0} : Interval{21.0, 30.0};
    ranges.rail_chance = report ? 0.65 : 0.75;
    ranges.rail = report ? Interval{6.0, 14.0} : Interval{7.0, 12.0};
    ranges.pole_gap = report ? Interval{15.0, 70.0} : Interval{18.0, 55.0};
    ranges.tree_gap = report ? Interval{4.0, 22.0} : Interval{4.0, 18.0};
    ranges.house_gap = report ? Interval{30.0, 200.0} : Interval{35.0, 140.0};
    ranges.pole_aside = report ? Interval{11.0, 25.0} : Interval{12.0, 22.0};
    ranges.aside = report ? Interval{14.0, 150.0} : Interval{15.0, 150.0};
    ranges.cars = report ? Interval{6.0, 26.0} : Interval{9.0, 23.0};
    ranges.car_speed = report ? Interval{18.0, 34.0} : Interval{20.0, 32.0};
    ranges.lorries = report ? 0.2 : 0.15;
  }
  return ranges;
}

/// The road's middle, about along x.
PathLine road(Random& random, double bends)
{
  const SmoothNoise bend(random, bends, 1.0 / 1500.0, 1.0 / 700.0, 3);
  std::vector<Eigen::Vector2d> points;
  for (double x = 0.0; x <= kRoadLength; x += 10.0) {
    points.emplace_back(x, bend(x) - bend(0.0));
  }
  return {points, 15.0};
}

/// A distance from the road: more stands near it than far from it.
double drawAside(Random& random, const Interval& aside)
{
  const double u = random.uniform();
  return aside.low + (aside.high - aside.low) * u * u;
}

double eitherSide(Random& random, double left)
{
  return random.chance(0.5) ? left : -left;
}

/// A low rail with its posts, about as high as the bonnet of a car.
void addRail(TriangleMesh& mesh, Random& random, const PathLine& line, const Terrain& terrain, double left)
{
  addStrip(mesh, random, line, terrain, {0.0, line.length(), 2.0}, {{left, 0.45}, {left + 0.06, 0.6}, {left, 0.75}},
           0.0, 0.6);
  for (double station = 0.0; station < line.length(); station += 4.0) {
    addBox(mesh, besideRoad(line, terrain, station, left), {0.1, 0.08, 0.7}, 0.5);
  }
}

/// The few things that stand in the country.
void addCountry(TriangleMesh& mesh, Random& random, const OpenRoadRanges& ranges, const PathLine& line,
                const Terrain& terrain)
{
  // Gaps are this drive's own: some roads have many poles and no trees, others the reverse.
  const double pole_gap = ranges.pole_gap.draw(random);
  const double tree_gap = ranges.tree_gap.draw(random);
  const double house_gap = ranges.house_gap.draw(random);
  for (double s = pole_gap * random.uniform(); s < line.length(); s += pole_gap * random.uniform(0.8, 1.2)) {
    const SE3 foot = besideRoad(line, terrain, s, eitherSide(random, ranges.pole_aside.draw(random)));
    addCylinder(mesh, foot, random.uniform(0.05, 0.14), random.uniform(4.0, 9.0), 0.4, 0.8);
  }
  for (double s = tree_gap * random.uniform(); s < line.length(); s += tree_gap * random.uniform(0.3, 1.7)) {
    addTree(mesh, random, besideRoad(line, terrain, s, eitherSide(random, drawAside(random, ranges.aside))));
  }
  for (double s = house_gap * random.uniform(); s < line.length(); s += house_gap * random.uniform(0.5, 1.5)) {
    const double width = random.uniform(8.0, 16.0);
    // At the left a facade that looks at the road begins at its far end and turns back.
    const double left = eitherSide(random, 12.0 + drawAside(random, ranges.aside));
    const double turn = (left > 0.0 ? M_PI : 0.0) + random.uniform(-0.6, 0.6);
    addHouse(mesh, random, besideRoad(line, terrain, s, left, turn), width);
  }
}

/// Vehicles on two lanes in each direction, from behind the sensor to as far ahead as it comes.
void addTraffic(World& world, Random& random, const OpenRoadRanges& ranges, const PathLine& line,
                const Terrain& terrain)
{
  const int count = static_cast<int>(std::lround(ranges.cars.draw(random)));
  const PathLine back = reversed(line);
  for (int i = 0; i < count; ++i) {
    const bool oncoming = i % 2 == 1;
    const double left = -kLaneWidth * (random.chance(0.5) ? 0.5 : 1.5);
    const double station =
        oncoming ? random.uniform(20.0, kRoadLength - kOpenRoadStart) : kOpenRoadStart + random.uniform(-120.0, 150.0);
    addVehicle(world, random, oncoming ? back : line, terrain, cruising(ranges.car_speed.draw(random), left, station),
               ranges.lorries);
  }
}

DriveStyle sensorDrive(const WorldOptions& options, double speed)
{
  // Every second way is driven in the other lane.
  DriveStyle style = cruising(speed, -kLaneWidth * (options.path % 2 == 0 ? 0.5 : 1.5), kOpenRoadStart);
  style.last_station = kOpenRoadStart + kOpenRoadWay;
  style.acceleration = kAcceleration;
  if (options.begin == Begin::rest) {
    style.start_speed = 0.0;
    style.wait = kStanding;
  }
  return style;
}

}  // namespace

World makeOpenRoad(const WorldOptions& options)
{
  Random random = randomOfWorld(options, 8);
  const OpenRoadRanges ranges = openRoadRangesOf(options.family);
  World world;
  Terrain terrain;
  terrain.addWaves(random, ranges.rolling.draw(random), ranges.hills.low, ranges.hills.high);
  terrain.addWaves(random, ranges.unevenness.draw(random), 5.0, 25.0);
  const PathLine line = road(random, ranges.bends.draw(random));
  const auto [low, high] = extentAcross(line);
  addGround(world.still, terrain, {-100.0, kRoadLength + 100.0, low - kSeen, high + kSeen, 2.0},
            [](double, double) { return 0.2; });
  const double lane = -1.5 * kLaneWidth;
  const double rail = ranges.rail.draw(random);
  const bool at_the_left = random.chance(kRailAtTheLeft);
  if (random.chance(ranges.rail_chance)) {
    addRail(world.still, random, line, terrain, at_the_left ? lane + rail + 2.0 * kLaneWidth : lane - rail);
  }
  addCountry(world.still, random, ranges, line, terrain);
  const double drawn = ranges.speed.draw(random);
  Random own = randomOfPath(options, random);
  const double speed = options.speed ? *options.speed : (options.path == 1 ? drawn : own.uniform(0.8, 1.0) * drawn);
  world.sensor_motion = drive(line, sensorDrive(options, speed), {1.9, 2.6, 0.003, 0.008}, terrain, own);
  world.acceleration = 3.5;
  addTraffic(world, random, ranges, line, terrain);
  return world;
}

}  // namespace pcl_floam::simulator
