#include "../objects.h"
#include "../world.h"
#include "city_block.h"

#include <algorithm>
#include <array>

namespace pcl_floam::simulator {

namespace {

constexpr double kUrbanSpeed = 12.0;  // m/s
constexpr double kUrbanLane = -2.2;   // m from the middle of the street: traffic keeps to the right

/// The crossings: a grid that is nowhere quite square.
using Crossings = std::array<std::array<Eigen::Vector2d, 5>, 5>;

Crossings placeCrossings(Random& random)
{
  constexpr std::array<double, 5> kX{-80.0, 0.0, 185.0, 335.0, 415.0};
  constexpr std::array<double, 5> kY{-80.0, 0.0, 120.0, 255.0, 335.0};
  Crossings crossings;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t k = 0; k < 5; ++k) {
      crossings[i][k] = {kX[i] + random.uniform(-9.0, 9.0), kY[k] + random.uniform(-9.0, 9.0)};
    }
  }
  return crossings;
}

/// The loop through the city, begun between two crossings; half a round more for those who drive ahead.
PathLine loop(const Crossings& at, bool backwards, double& length)
{
  std::vector<Eigen::Vector2d> corners{at[2][1], at[2][2], at[3][2], at[3][3], at[2][3], at[1][3], at[1][2], at[1][1]};
  const Eigen::Vector2d start = 0.6 * at[1][1] + 0.4 * at[2][1];
  if (backwards) {
    std::reverse(corners.begin(), corners.end());
  }
  std::vector<Eigen::Vector2d> points{start};
  points.insert(points.end(), corners.begin(), corners.end());
  points.push_back(start);
  length = PathLine(points, 8.0).length();
  points.insert(points.end(), corners.begin(), corners.end());
  return {points, 8.0};
}

void addCarOn(World& world, Random& random, const PathLine& line, const Terrain& terrain, const DriveStyle& style)
{
  MovingObject car{{}, drive(line, style, {0.0, 2.5, 0.0, 0.0}, terrain, random), 3.6};
  addCar(car.shape, random, SE3());
  world.moving.push_back(car);
}

DriveStyle cityDriving(double speed)
{
  DriveStyle style;
  style.speed = speed;
  style.acceleration = 1.5;
  style.side_acceleration = 2.2;
  style.left = kUrbanLane;
  return style;
}

void addTraffic(World& world, Random& random, const Crossings& at, const PathLine& way, const Terrain& terrain)
{
  for (const double ahead : {22.0, 48.0}) {
    DriveStyle style = cityDriving(kUrbanSpeed);
    style.first_station = ahead;
    addCarOn(world, random, way, terrain, style);
  }
  double length = 0.0;
  const PathLine back = loop(at, true, length);
  for (int i = 0; i < 9; ++i) {
    DriveStyle style = cityDriving(random.uniform(8.0, 11.0));
    style.first_station = 20.0 + 60.0 * i + random.uniform(0.0, 25.0);
    style.start_speed = 5.0;
    addCarOn(world, random, back, terrain, style);
  }
  for (std::size_t k = 1; k <= 3; ++k) {
    // Across the city on each street, in both directions, two of them a while after one another.
    for (int i = 0; i < 4; ++i) {
      const bool east = i % 2 == 0;
      const PathLine street(
          {east ? at[0][k] : at[4][k], at[east ? 1 : 3][k], at[2][k], at[east ? 3 : 1][k], east ? at[4][k] : at[0][k]},
          8.0);
      addCarOn(world, random, street, terrain,
               cityDriving(i < 2 ? random.uniform(2.5, 4.0) : random.uniform(6.0, 10.0)));
    }
  }
}

/// People walk round and round the blocks.
void addPedestrians(World& world, Random& random, const std::vector<BlockOutline>& blocks, const Terrain& terrain,
                    double duration)
{
  for (const BlockOutline& block : blocks) {
    const BlockOutline way = inset(block, 7.0);
    for (int i = 0; i < 2; ++i) {
      DriveStyle style;
      style.speed = random.uniform(1.0, 1.6);
      std::vector<Eigen::Vector2d> points;
      const int first = random.index(4);
      for (int corner = 0; corner < 2 + static_cast<int>(1.6 * duration / 60.0); ++corner) {
        points.push_back(way[static_cast<std::size_t>((first + corner) % 4)]);
      }
      style.first_station = random.uniform(0.0, 40.0);
      MovingObject person{{}, drive(PathLine(points, 1.0), style, {0.12, 0.0, 0.0, 0.0}, terrain, random), 2.0};
      addPerson(person.shape, random, SE3());
      world.moving.push_back(person);
    }
  }
}

}  // namespace

World makeUrban(const WorldOptions& options)
{
  Random random(options.seed, 3);
  World world;
  world.default_sensor = "hdl64";
  Terrain terrain;
  terrain.addWaves(random, 2.2, 180.0, 420.0);
  terrain.addWaves(random, 0.008, 3.0, 15.0);
  addGround(world.still, terrain, {-170.0, 500.0, -170.0, 420.0, 1.0}, [](double, double) { return 0.18; });
  const Crossings at = placeCrossings(random);
  std::vector<BlockOutline> blocks;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      blocks.push_back({at[i][k], at[i + 1][k], at[i + 1][k + 1], at[i][k + 1]});
      addCityBlock(world.still, random, terrain, blocks.back());
    }
  }
  double length = 0.0;
  // Every second way goes round the loop the other way, in the other lane; the third and fourth begin elsewhere.
  const PathLine way = loop(at, options.path % 2 == 0, length);
  DriveStyle style = cityDriving(kUrbanSpeed);
  Random own = randomOfPath(options, random);
  style.first_station = options.path > 2 ? own.uniform(20.0, 200.0) : 0.0;
  style.last_station = style.first_station + length;
  world.sensor_motion = drive(way, style, {1.8, 2.5, 0.005, 0.006}, terrain, own);
  random = options.path == 1 ? own : random;
  world.acceleration = 5.0;
  addTraffic(world, random, at, way, terrain);
  if (options.truck) {
    style.left = kUrbanLane + 3.6;
    MovingObject truck{{}, drive(way, style, {0.0, 2.5, 0.0, 0.0}, terrain, own), 2.5};
    addTruck(truck.shape, own, SE3());
    world.moving.push_back(truck);
  }
  addPedestrians(world, random, blocks, terrain, world.sensor_motion.duration());
  return world;
}

}  // namespace pcl_floam::simulator
