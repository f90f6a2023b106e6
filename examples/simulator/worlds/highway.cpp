#include "../objects.h"
#include "../roadside.h"
#include "../world.h"
#include "road.h"

#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kHighwaySpeed = 25.0;   // m/s
constexpr double kHighwayStart = 150.0;  // m along the road where the sensor starts
constexpr double kLastStation = 1260.0;  // m
constexpr double kOuterLane = -7.2;      // m from the road's middle
constexpr double kInnerLane = -3.5;      // m
constexpr double kLorries = 0.3;         // of the vehicles

/// Long bends to both sides.
PathLine road(Random& random)
{
  const SmoothNoise bend(random, 30.0, 1.0 / 1600.0, 1.0 / 700.0, 3);
  std::vector<Eigen::Vector2d> points;
  for (double x = 0.0; x <= 1700.0; x += 10.0) {
    points.emplace_back(x, bend(x) - bend(0.0));
  }
  return {points, 15.0};
}

/// Rails, their posts, banks: the same all along the road but for the posts and the banks' unevenness.
void addLongStructures(TriangleMesh& mesh, Random& random, const PathLine& line, const Terrain& terrain)
{
  const StripExtent all{0.0, line.length(), 2.0};
  for (const double left : {-14.0, -0.9, 0.9, 14.0}) {
    addStrip(mesh, random, line, terrain, all, {{left, 0.45}, {left + 0.06, 0.6}, {left, 0.75}}, 0.0, 0.6);
    for (double station = 0.0; station < all.to; station += 4.0) {
      addBox(mesh, besideRoad(line, terrain, station, left), {0.1, 0.08, 0.7}, 0.5);
    }
  }
  for (const double side : {-1.0, 1.0}) {
    addStrip(mesh, random, line, terrain, all,
             {{side * 18.0, -0.3}, {side * 21.0, 1.3}, {side * 24.0, 2.6}, {side * 27.0, 2.7}, {side * 34.0, -0.5}},
             0.08, 0.4);
  }
}

/// The few things that tell how far one has come.
void addLandmarks(TriangleMesh& mesh, Random& random, const PathLine& line, const Terrain& terrain)
{
  for (double station = 20.0; station < line.length(); station += 50.0) {
    for (const double left : {-14.8, 14.8}) {
      addBox(mesh, besideRoad(line, terrain, station, left), {0.08, 0.12, 1.05}, 0.9);
    }
  }
  for (double station = 60.0; station < line.length(); station += random.uniform(90.0, 160.0)) {
    addSign(mesh, random, besideRoad(line, terrain, station, random.chance(0.5) ? -15.5 : 15.5, M_PI));
  }
  for (double station = 330.0; station < line.length(); station += random.uniform(380.0, 460.0)) {
    for (const double left : {-15.8, 15.8}) {
      addBox(mesh, besideRoad(line, terrain, station, left), {0.4, 0.4, 7.0}, 0.5);
    }
    addBox(mesh, besideRoad(line, terrain, station, 0.0) * upright(0.0, 0.0, 6.2), {0.5, 31.6, 0.8}, 0.5);
    addBox(mesh, besideRoad(line, terrain, station, -6.0) * upright(-0.4, 0.0, 5.6), {0.1, 6.0, 2.2}, 0.9);
  }
  for (double station = 0.0; station < line.length(); station += random.uniform(15.0, 40.0)) {
    const double left = random.uniform(24.0, 50.0);
    addTree(mesh, random, besideRoad(line, terrain, station, random.chance(0.5) ? left : -left) * upright(0, 0, 1.5));
  }
}

/// A lorry that overtakes slowly: for half a minute it is beside the sensor.
void addOvertakingTruck(World& world, Random& random, const PathLine& line, const Terrain& terrain, double speed)
{
  const DriveStyle style = cruising(speed + 0.5, kInnerLane, kHighwayStart - 10.0);
  MovingObject truck{{}, drive(line, style, {0.0, 2.6, 0.0, 0.0}, terrain, random), 2.5};
  addTruck(truck.shape, random, SE3());
  world.moving.push_back(truck);
}

void addTraffic(World& world, Random& random, const PathLine& line, const Terrain& terrain)
{
  for (double station = 20.0; station < 500.0; station += random.uniform(45.0, 90.0)) {
    addVehicle(world, random, line, terrain, cruising(random.uniform(27.0, 30.0), kInnerLane, station), kLorries);
  }
  for (const double ahead : {38.0, 95.0, -30.0}) {
    addVehicle(world, random, line, terrain, cruising(kHighwaySpeed, kOuterLane, kHighwayStart + ahead), kLorries);
  }
  const PathLine back = reversed(line);
  for (int i = 0; i < 24; ++i) {
    const bool inner = i % 2 == 0;
    const double station = 55.0 * i + random.uniform(0.0, 40.0);
    addVehicle(world, random, back, terrain, cruising(inner ? 30.0 : 25.0, inner ? kInnerLane : kOuterLane, station),
               kLorries);
  }
}

}  // namespace

World makeHighway(const WorldOptions& options)
{
  Random random(options.seed, 4);
  World world;
  world.default_sensor = "hdl64";
  Terrain terrain;
  terrain.addWaves(random, 1.2, 350.0, 900.0);
  terrain.addWaves(random, 0.006, 6.0, 25.0);
  const PathLine line = road(random);
  const auto [low, high] = extentAcross(line);
  addGround(world.still, terrain, {-150.0, 1850.0, low - 90.0, high + 90.0, 2.0}, [](double, double) { return 0.2; });
  addLongStructures(world.still, random, line, terrain);
  addLandmarks(world.still, random, line, terrain);
  // Other ways are driven at other speeds.
  Random own = randomOfPath(options, random);
  const double speed = options.path == 1 ? kHighwaySpeed : own.uniform(20.0, 25.0);
  DriveStyle style = cruising(speed, kOuterLane, kHighwayStart);
  style.last_station = kLastStation;
  world.sensor_motion = drive(line, style, {1.9, 2.6, 0.003, 0.008}, terrain, own);
  random = options.path == 1 ? own : random;
  world.acceleration = 3.0;
  addTraffic(world, random, line, terrain);
  if (options.truck) {
    addOvertakingTruck(world, own, line, terrain, speed);
  }
  return world;
}

}  // namespace pcl_floam::simulator
