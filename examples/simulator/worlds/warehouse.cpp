#include "../objects.h"
#include "../world.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kHalfLength = 30.0;  // m, the hall reaches from -x to x
constexpr double kHalfWidth = 20.0;   // m
constexpr double kHallHeight = 8.5;   // m
constexpr int kRows = 6;              // rows of racks, two racks back to back
constexpr double kRowSpacing = 5.5;   // m
constexpr int kBays = 13;
constexpr double kBay = 2.7;         // m
constexpr double kRackDepth = 1.05;  // m

double rowPlace(int row)
{
  return kRowSpacing * (row - 0.5 * (kRows - 1));
}

/// Pallets with loads of uneven size in one bay, on one level.
void addLoads(TriangleMesh& mesh, Random& random, const SE3& world_T_bay)
{
  for (const double x : {-0.65, 0.65}) {
    if (random.chance(0.22)) {
      continue;
    }
    const SE3 place = world_T_bay * upright(x + random.uniform(-0.06, 0.06), random.uniform(-0.12, 0.12), 0.0,
                                            random.uniform(-0.08, 0.08));
    addBox(mesh, place, {1.1, 0.8, 0.14}, 0.3);
    const Eigen::Vector3d size(random.uniform(0.7, 1.15), random.uniform(0.6, 0.9), random.uniform(0.3, 1.35));
    addBox(mesh, place * upright(0.0, 0.0, 0.14), size, random.uniform(0.2, 0.8), random.uniform(0.9, 1.0));
  }
}

/// One row: two racks back to back.
void addRackRow(TriangleMesh& mesh, Random& random, const SE3& world_T_row)
{
  constexpr double kLevels[] = {0.0, 1.75, 3.5, 5.25};
  for (int border = 0; border <= kBays; ++border) {
    const double x = kBay * (border - 0.5 * kBays);
    for (const double y : {-kRackDepth, -0.08, 0.08, kRackDepth}) {
      addBox(mesh, world_T_row * upright(x, y, 0.0), {0.1, 0.08, 6.6}, 0.45);
    }
  }
  for (const double level : kLevels) {
    for (const double side : {-1.0, 1.0}) {
      if (level > 0.0) {
        addBox(mesh, world_T_row * upright(0.0, side * kRackDepth, level - 0.12), {kBay * kBays, 0.05, 0.12}, 0.6);
      }
      for (int bay = 0; bay < kBays; ++bay) {
        const double x = kBay * (bay - 0.5 * (kBays - 1));
        addLoads(mesh, random, world_T_row * upright(x, 0.55 * side, level));
      }
    }
  }
}

void addWall(TriangleMesh& mesh, Random& random, const SE3& world_T_wall, double length)
{
  std::vector<double> columns{0.0};
  for (double x = 3.0; x < length - 2.0; x += random.uniform(4.5, 6.0)) {
    columns.insert(columns.end(), {x, x + 0.4});
  }
  columns.push_back(length);
  Relief relief(columns, {0.0, 1.2, 3.5, kHallHeight}, {0.0, 0.5});
  for (std::size_t c = 0; c + 1 < columns.size(); ++c) {
    const bool gate = c % 2 == 0 && random.chance(0.25);
    for (std::size_t r = 0; r < 3; ++r) {
      relief.cell(r, c).depth = c % 2 == 1 ? 0.3 : (gate && r < 2 ? -0.35 : 0.0);
    }
  }
  addRelief(mesh, world_T_wall, relief);
}

void addHall(TriangleMesh& mesh, Random& random)
{
  addWall(mesh, random, upright(-kHalfLength, -kHalfWidth, 0.0, 0.0), 2.0 * kHalfLength);
  addWall(mesh, random, upright(kHalfLength, -kHalfWidth, 0.0, M_PI / 2.0), 2.0 * kHalfWidth);
  addWall(mesh, random, upright(kHalfLength, kHalfWidth, 0.0, M_PI), 2.0 * kHalfLength);
  addWall(mesh, random, upright(-kHalfLength, kHalfWidth, 0.0, -M_PI / 2.0), 2.0 * kHalfWidth);
  for (const double z : {0.0, kHallHeight}) {
    const double x = kHalfLength + 1.0;
    const double y = kHalfWidth + 1.0;
    addQuad(
        mesh,
        {Eigen::Vector3d(-x, -y, z), Eigen::Vector3d(x, -y, z), Eigen::Vector3d(x, y, z), Eigen::Vector3d(-x, y, z)},
        0.4);
  }
  for (double x = -kHalfLength + 3.0; x < kHalfLength; x += 6.0) {
    addBox(mesh, upright(x, 0.0, kHallHeight - 0.8), {0.25, 2.0 * kHalfWidth, 0.5}, 0.5);
  }
}

void addFloorObjects(TriangleMesh& mesh, Random& random)
{
  for (int row = 0; row < kRows; ++row) {
    for (const double x : {-19.8, 19.8}) {
      addBox(mesh, upright(x, rowPlace(row), 0.0), {0.45, 0.45, kHallHeight}, 0.5);
    }
  }
  for (int i = 0; i < 6; ++i) {
    const SE3 place = upright(random.uniform(26.8, 27.8), -16.0 + 5.6 * i + random.uniform(-0.8, 0.8), 0.0,
                              M_PI / 2.0 + random.uniform(-0.4, 0.4));
    addMachine(mesh, random, place);
  }
  for (int i = 0; i < 9; ++i) {
    const SE3 place = upright(-28.8 + random.uniform(-0.3, 0.3), -17.0 + 4.2 * i, 0.0, random.uniform(-0.5, 0.5));
    addBox(mesh, place, {random.uniform(0.6, 1.2), random.uniform(0.6, 1.4), random.uniform(0.6, 2.0)}, 0.5);
  }
}

/// Up one aisle and down the next, then back along the wall to where it began. Other ways start at another aisle, and
/// every second one goes the other way round.
PathLine path(int number)
{
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i + 1 < kRows; ++i) {
    const int aisle = (2 * (number - 1) + i) % (kRows - 1);
    const double y = 0.5 * (rowPlace(aisle) + rowPlace(aisle + 1));
    const double side = (i % 2 == 0) == (number % 2 == 1) ? -22.5 : 22.5;
    points.emplace_back(side, y);
    points.emplace_back(-side, y);
  }
  const double turn = number % 2 == 1 ? 1.0 : -1.0;
  points.emplace_back(22.5 * turn, 17.3);
  points.emplace_back(-25.0 * turn, 17.3);
  points.emplace_back(-25.0 * turn, points.front().y());
  points.push_back(points.front());
  return {points, 1.6};
}

/// Workers walk round and round within their aisle, and across its ends.
void addWorkers(World& world, Random& random, double duration)
{
  constexpr double kAside = 1.15;  // m from the middle of the aisle: room for the robot between them
  for (int i = 0; i < 16; ++i) {
    const int aisle = i % (kRows - 1);
    const double y = 0.5 * (rowPlace(aisle) + rowPlace(aisle + 1));
    const double from = random.uniform(-17.0, 5.0);
    const double to = from + random.uniform(8.0, 14.0);
    std::vector<Eigen::Vector2d> points;
    DriveStyle style;
    style.speed = random.uniform(0.8, 1.5);
    for (double gone = 0.0; gone < 1.2 * style.speed * duration; gone += 2.0 * (to - from) + 4.0 * kAside) {
      points.insert(points.end(), {{from, y - kAside}, {to, y - kAside}, {to, y + kAside}, {from, y + kAside}});
    }
    style.first_station = random.uniform(0.0, 20.0);
    MovingObject worker{{}, drive(PathLine(points, 0.6), style, BodyStyle(), Terrain(), random), 0.75};
    addPerson(worker.shape, random, SE3());
    world.moving.push_back(worker);
  }
}

}  // namespace

World makeWarehouse(const WorldOptions& options)
{
  Random random(options.seed, 1);
  World world;
  addHall(world.still, random);
  addFloorObjects(world.still, random);
  for (int row = 0; row < kRows; ++row) {
    addRackRow(world.still, random,
               upright(random.uniform(-0.3, 0.3), rowPlace(row), 0.0, random.uniform(-0.004, 0.004)));
  }
  DriveStyle style;
  style.speed = 2.0;
  Random own = randomOfPath(options, random);
  world.sensor_motion = drive(path(options.path), style, {1.0, 0.7, 0.004, 0.003}, Terrain(), own);
  random = options.path == 1 ? own : random;
  world.acceleration = 2.0;
  addWorkers(world, random, world.sensor_motion.duration());
  return world;
}

}  // namespace pcl_floam::simulator
