#include "../world.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kCorridorWay = 130.0;   // m to go
constexpr double kBeyond = 110.0;        // m of corridor before and after it: longer than the sensor sees
constexpr double kWidth = 2.4;           // m
constexpr double kCorridorHeight = 2.7;  // m
constexpr double kDoorWidth = 0.95;
constexpr double kFrame = 0.07;  // m, width of a door's frame

/// A wall with doors at the given places.
Relief wall(const std::vector<double>& doors)
{
  std::vector<double> columns{-kBeyond};
  for (const double door : doors) {
    columns.insert(columns.end(), {door - kFrame, door, door + kDoorWidth, door + kDoorWidth + kFrame});
  }
  columns.push_back(kCorridorWay + kBeyond);
  Relief relief(columns, {0.0, 2.05, 2.05 + kFrame, kCorridorHeight}, {0.0, 0.65});
  constexpr ReliefCell kFrameCell{0.02, 0.5};
  for (std::size_t i = 0; i < doors.size(); ++i) {
    const std::size_t first = 4 * i + 1;
    for (const std::size_t column : {first, first + 2}) {
      relief.cell(0, column) = kFrameCell;
    }
    relief.cell(0, first + 1) = {-0.12, 0.45};
    for (std::size_t column = first; column < first + 3; ++column) {
      relief.cell(1, column) = kFrameCell;
    }
  }
  return relief;
}

/// Places of the doors along each side: one every 5 to 11 m, on either side or on both.
std::array<std::vector<double>, 2> placeDoors(Random& random)
{
  std::array<std::vector<double>, 2> doors;
  for (double x = -kBeyond + 3.0; x < kCorridorWay + kBeyond - 3.0; x += random.uniform(5.0, 11.0)) {
    const int where = random.index(3);
    if (where != 1) {
      doors[0].push_back(x);
    }
    if (where != 0) {
      doors[1].push_back(x + random.uniform(-0.5, 0.5));
    }
  }
  return doors;
}

}  // namespace

World makeCorridor(const WorldOptions& options)
{
  Random random(options.seed, 5);
  World world;
  std::array<std::vector<double>, 2> doors;
  if (!options.smooth) {
    doors = placeDoors(random);
  }
  addRelief(world.still, upright(0.0, -0.5 * kWidth, 0.0), wall(doors[0]));
  // The other wall is seen from its other side: its doors recede away from the corridor as well.
  std::vector<double> mirrored;
  for (auto door = doors[1].rbegin(); door != doors[1].rend(); ++door) {
    mirrored.push_back(kCorridorWay - *door - kDoorWidth);
  }
  addRelief(world.still, upright(kCorridorWay, 0.5 * kWidth, 0.0, M_PI), wall(mirrored));
  for (const double z : {0.0, kCorridorHeight}) {
    addQuad(world.still,
            {Eigen::Vector3d(-kBeyond, -kWidth, z), Eigen::Vector3d(kCorridorWay + kBeyond, -kWidth, z),
             Eigen::Vector3d(kCorridorWay + kBeyond, kWidth, z), Eigen::Vector3d(-kBeyond, kWidth, z)},
            z > 0.0 ? 0.7 : 0.3);
  }
  Random own = randomOfPath(options, random);
  // Other ways keep to one side, and every second one comes back.
  const double aside = options.path == 1 ? 0.0 : own.uniform(-0.35, 0.35);
  const bool back = options.path % 2 == 0;
  const SmoothNoise weave(own, 0.12, 1.0 / 40.0, 1.0 / 18.0);
  std::vector<Eigen::Vector2d> points;
  for (double x = 0.0; x <= kCorridorWay; x += 1.0) {
    points.emplace_back(back ? kCorridorWay - x : x, aside + weave(x));
  }
  DriveStyle style;
  style.speed = 1.5;
  world.sensor_motion = drive(PathLine(points, 2.0), style, {0.9, 0.5, 0.004, 0.002}, Terrain(), own);
  world.acceleration = 2.0;
  return world;
}

World makeTunnel(const WorldOptions& options)
{
  WorldOptions smooth = options;
  smooth.smooth = true;
  return makeCorridor(smooth);
}

}  // namespace pcl_floam::simulator
