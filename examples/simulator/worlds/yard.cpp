#include "../objects.h"
#include "../path_line.h"
#include "../roadside.h"
#include "../world.h"
#include "road.h"

#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kGround = 90.0;     // m of ground to each side of the middle
constexpr double kRoundClear = 4.0;  // m that things keep from the sensor's way

/// What the generator draws from; as it stands, for \ref Family::tune.
struct YardRanges {
  Interval half{18.0, 30.0};      ///< m from the middle to the edge
  double built = 0.5;             ///< of the edge has buildings
  Interval building{10.0, 30.0};  ///< m wide
  Interval vehicles{3.0, 10.0};   ///< parked
  Interval poles{3.0, 10.0};      ///< lamps and signs
  Interval trees{2.0, 12.0};
  Interval people{1.0, 5.0};
  Interval unevenness{0.01, 0.05};  ///< m, standard deviation of the ground's height
  Interval slope{0.1, 0.6};         ///< m, that of its slow rise and fall
};

YardRanges yardRangesOf(Family family)
{
  YardRanges ranges;
  if (family != Family::tune) {
    const bool report = family == Family::report;
    ranges.half = report ? Interval{14.0, 45.0} : Interval{16.0, 38.0};
    ranges.built = report ? 0.4 : 0.45;
    ranges.building = report ? Interval{6.0, 40.0} : Interval{8.0, 35.0};
    ranges.vehicles = report ? Interval{0.0, 16.0} : Interval{1.0, 13.0};
    ranges.poles = report ? Interval{1.0, 16.0} : Interval{2.0, 13.0};
    ranges.trees = report ? Interval{0.0, 20.0} : Interval{1.0, 16.0};
    ranges.people = report ? Interval{0.0, 8.0} : Interval{0.0, 6.0};
    ranges.unevenness = report ? Interval{0.005, 0.08} : Interval{0.01, 0.06};
    ranges.slope = report ? Interval{0.0, 1.2} : Interval{0.0, 0.9};
  }
  return ranges;
}

int drawCount(Random& random, const Interval& range)
{
  return static_cast<int>(std::lround(range.draw(random)));
}

/// The sensor's round: a rectangle about the middle.
PathLine roundOf(double half)
{
  const double side = 0.6 * half;
  return {{{-side, -side}, {side, -side}, {side, side}, {-side, side}, {-side, -side}}, 3.0};
}

bool keepsClear(const PathLine& way, double x, double y, double distance)
{
  for (double station = 0.0; station < way.length(); station += 1.0) {
    if ((way.at(station) - Eigen::Vector2d(x, y)).norm() < distance) {
      return false;
    }
  }
  return true;
}

void addBuildings(TriangleMesh& mesh, Random& random, const YardRanges& ranges, const Terrain& terrain, double half)
{
  for (int side = 0; side < 4; ++side) {
    const double turn = 0.5 * M_PI * side;
    for (double along = -half; along < half;) {
      const double width = ranges.building.draw(random);
      if (random.chance(ranges.built)) {
        // A facade looks along its y axis: towards the middle.
        const Eigen::Vector2d corner =
            Eigen::Rotation2Dd(turn) * Eigen::Vector2d(along, -half - random.uniform(0.0, 8.0));
        addHouse(mesh, random, upright(corner.x(), corner.y(), terrain.height(corner.x(), corner.y()), turn), width);
      }
      along += width + random.uniform(0.0, 10.0);
    }
  }
}

void addThings(TriangleMesh& mesh, Random& random, const YardRanges& ranges, const Terrain& terrain,
               const PathLine& way, double half)
{
  const auto scatter = [&](int count, double distance, const auto& add) {
    for (int i = 0; i < count; ++i) {
      const double x = random.uniform(-half, half);
      const double y = random.uniform(-half, half);
      const SE3 place = upright(x, y, terrain.height(x, y), random.uniform(0.0, 2.0 * M_PI));
      if (keepsClear(way, x, y, distance)) {
        add(place);
      }
    }
  };
  scatter(drawCount(random, ranges.vehicles), kRoundClear,
          [&](const SE3& place) { random.chance(0.2) ? addTruck(mesh, random, place) : addCar(mesh, random, place); });
  scatter(drawCount(random, ranges.poles), 2.0, [&](const SE3& place) {
    random.chance(0.5) ? addLamp(mesh, place, random.uniform(4.0, 8.0)) : addSign(mesh, random, place);
  });
  scatter(drawCount(random, ranges.trees), kRoundClear, [&](const SE3& place) { addTree(mesh, random, place); });
}

/// People who walk across.
void addPeople(World& world, Random& random, const YardRanges& ranges, const Terrain& terrain, double half)
{
  const int count = drawCount(random, ranges.people);
  for (int i = 0; i < count; ++i) {
    DriveStyle style;
    style.speed = random.uniform(0.5, 1.5);
    std::vector<Eigen::Vector2d> points;
    for (int k = 0; k < 8; ++k) {
      points.emplace_back(random.uniform(-half, half), random.uniform(-half, half));
    }
    MovingObject person{{}, drive(PathLine(points, 0.5), style, BodyStyle(), terrain, random), 0.8};
    addPerson(person.shape, random, SE3());
    world.moving.push_back(person);
  }
}

}  // namespace

World makeYard(const WorldOptions& options)
{
  constexpr std::uint64_t kPurpose = 12;
  Random random = randomOfWorld(options, kPurpose);
  const YardRanges ranges = yardRangesOf(options.family);
  World world;
  Terrain terrain;
  terrain.addWaves(random, ranges.slope.draw(random), 40.0, 120.0);
  terrain.addWaves(random, ranges.unevenness.draw(random), 3.0, 15.0);
  addGround(world.still, terrain, {-kGround, kGround, -kGround, kGround, 1.0}, [](double, double) { return 0.2; });
  const double half = ranges.half.draw(random);
  const PathLine way = roundOf(half);
  addBuildings(world.still, random, ranges, terrain, half);
  addThings(world.still, random, ranges, terrain, way, half);
  DriveStyle style;
  style.speed = 3.0;
  Random own = randomOfPath(options, random);
  if (options.path > 1) {
    style.left = (options.path % 2 == 0 ? -1.0 : 1.0) * own.uniform(0.5, 1.2);
  }
  world.sensor_motion = drive(way, style, {1.8, 2.0, 0.003, 0.004}, terrain, own);
  world.acceleration = 3.0;
  addPeople(world, random, ranges, terrain, half);
  return world;
}

}  // namespace pcl_floam::simulator
