#include "../objects.h"
#include "../world.h"

#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr int kAisles = 3;
constexpr double kAisle = 6.0;     // m wide
constexpr double kStall = 2.5;     // m wide
constexpr double kDepth = 5.0;     // m, of a stall
constexpr double kCrossing = 7.0;  // m wide, at both ends of the aisles
constexpr double kModule = kAisle + 2.0 * kDepth;
constexpr double kHalfWidth = 0.5 * kAisles * kModule;

/// What a garage is like, by its family.
struct Garage {
  double half_length = 0.0;  ///< m
  double height = 0.0;       ///< m
  double taken = 0.0;        ///< share of the stalls with a car in it
  double bays = 0.0;         ///< stalls from column to column
};

Garage garageOf(Random& random, Family family)
{
  const bool tune = family == Family::tune;
  const Interval length = tune ? Interval{28.0, 36.0} : Interval{24.0, 45.0};
  const Interval height = tune ? Interval{2.5, 3.0} : Interval{2.3, 3.4};
  const Interval taken = tune ? Interval{0.4, 0.7} : Interval{0.1, 0.9};
  return {length.draw(random), height.draw(random), taken.draw(random), random.chance(0.5) ? 2.0 : 3.0};
}

double middleOf(int aisle)
{
  return kModule * (aisle - 0.5 * (kAisles - 1));
}

/// Floor, ceiling with beams and pipes, walls with pilasters.
void addShell(TriangleMesh& mesh, Random& random, const Garage& garage)
{
  const double x = garage.half_length + 0.5;
  const double y = kHalfWidth + 0.5;
  for (const double z : {0.0, garage.height}) {
    addQuad(
        mesh,
        {Eigen::Vector3d(-x, -y, z), Eigen::Vector3d(x, -y, z), Eigen::Vector3d(x, y, z), Eigen::Vector3d(-x, y, z)},
        0.4);
  }
  const double spacing = garage.bays * kStall;
  for (double beam = -garage.half_length + kCrossing; beam < garage.half_length - kCrossing + 0.1; beam += spacing) {
    addBox(mesh, upright(beam, 0.0, garage.height - 0.35), {0.4, 2.0 * kHalfWidth, 0.35}, 0.5);
    for (const double side : {-1.0, 1.0}) {
      addBox(mesh, upright(beam, side * kHalfWidth, 0.0), {0.4, 0.5, garage.height}, 0.5);
    }
    for (int wall = 1; wall < kAisles; ++wall) {
      addBox(mesh, upright(beam, -kHalfWidth + kModule * wall, 0.0), {0.35, 0.35, garage.height}, 0.5);
    }
  }
  for (int aisle = 0; aisle < kAisles; ++aisle) {
    addBox(mesh, upright(0.0, middleOf(aisle) + random.uniform(1.5, 2.5), garage.height - 0.55),
           {2.0 * garage.half_length, 0.15, 0.15}, 0.6);
  }
  for (const double side : {-1.0, 1.0}) {
    addBox(mesh, upright(0.0, side * (kHalfWidth + 0.1), 0.0), {2.0 * x, 0.2, garage.height}, 0.5);
    addBox(mesh, upright(side * (garage.half_length + 0.1), 0.0, 0.0), {0.2, 2.0 * y, garage.height}, 0.5);
  }
}

/// Stairs and lifts, ticket machines, what else stands along the end walls.
void addFixtures(TriangleMesh& mesh, Random& random, const Garage& garage)
{
  for (const double side : {-1.0, 1.0}) {
    addBox(mesh, upright(side * (garage.half_length - 1.2), random.uniform(-kHalfWidth + 2.0, kHalfWidth - 2.0), 0.0),
           {2.2, random.uniform(2.5, 4.0), garage.height}, 0.6);
    for (int i = 0; i < 4; ++i) {
      addBox(mesh,
             upright(side * (garage.half_length - 0.4), random.uniform(-kHalfWidth, kHalfWidth), 0.0,
                     random.uniform(-0.1, 0.1)),
             {random.uniform(0.3, 0.6), random.uniform(0.3, 1.0), random.uniform(0.8, 1.9)}, 0.5);
    }
  }
}

/// Parked nose first or last, each a little askew.
void addParkedCars(TriangleMesh& mesh, Random& random, const Garage& garage)
{
  for (int aisle = 0; aisle < kAisles; ++aisle) {
    for (const double side : {-1.0, 1.0}) {
      const double y = middleOf(aisle) + side * 0.5 * (kAisle + kDepth);
      for (double x = -garage.half_length + kCrossing + 0.5 * kStall; x < garage.half_length - kCrossing; x += kStall) {
        if (random.chance(garage.taken)) {
          const double turn = (random.chance(0.5) ? 0.5 : -0.5) * M_PI + random.uniform(-0.04, 0.04);
          addCar(mesh, random, upright(x + random.uniform(-0.2, 0.2), y + random.uniform(-0.2, 0.2), 0.0, turn));
        }
      }
    }
  }
}

/// Up one aisle, down the next, and back along the outermost. Other ways begin at another aisle.
PathLine path(const Garage& garage, int number)
{
  const double end = garage.half_length - 0.5 * kCrossing;
  std::vector<Eigen::Vector2d> points;
  double side = -1.0;
  for (int i = 0; i <= kAisles; ++i, side = -side) {
    const double y = middleOf((number - 1 + i) % kAisles);
    points.emplace_back(side * end, y);
    points.emplace_back(-side * end, y);
  }
  return {points, 1.8};
}

/// People who walk to their cars, and a car that looks for a stall.
void addTraffic(World& world, Random& random, const Garage& garage, double duration)
{
  const double end = garage.half_length - kCrossing;
  for (int i = 0; i < 2 * kAisles; ++i) {
    const double y = middleOf(i % kAisles) + (i < kAisles ? 2.3 : -2.3);
    DriveStyle style;
    style.speed = random.uniform(0.8, 1.5);
    std::vector<Eigen::Vector2d> points;
    for (double gone = 0.0; gone < style.speed * duration; gone += 4.0 * end) {
      points.insert(points.end(), {{-end, y}, {end, y}, {end, y + 0.4}, {-end, y + 0.4}});
    }
    style.first_station = random.uniform(0.0, 2.0 * end);
    MovingObject person{{}, drive(PathLine(points, 0.15), style, BodyStyle(), Terrain(), random), 0.8};
    addPerson(person.shape, random, SE3());
    world.moving.push_back(person);
  }
  DriveStyle style;
  style.speed = random.uniform(2.0, 4.0);
  style.wait = random.uniform(0.0, 20.0);
  const double lane = middleOf(random.index(kAisles)) + 1.0;
  MovingObject car{{}, drive(PathLine({{end, lane}, {-end, lane}}, 1.0), style, BodyStyle(), Terrain(), random), 2.8};
  addCar(car.shape, random, SE3());
  world.moving.push_back(car);
}

}  // namespace

World makeCarPark(const WorldOptions& options)
{
  constexpr std::uint64_t kPurpose = 11;
  Random random = randomOfWorld(options, kPurpose);
  const Garage garage = garageOf(random, options.family);
  World world;
  addShell(world.still, random, garage);
  addFixtures(world.still, random, garage);
  addParkedCars(world.still, random, garage);
  DriveStyle style;
  style.speed = 3.0;
  Random own = randomOfPath(options, random);
  world.sensor_motion = drive(path(garage, options.path), style, {1.3, 1.2, 0.005, 0.004}, Terrain(), own);
  random = options.path == 1 ? own : random;
  world.acceleration = 2.0;
  addTraffic(world, random, garage, world.sensor_motion.duration());
  return world;
}

}  // namespace pcl_floam::simulator
