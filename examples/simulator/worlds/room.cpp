#include "../objects.h"
#include "../world.h"
#include "indoor.h"

#include <cmath>

namespace pcl_floam::simulator {

namespace {

/// Rounds within \p reach of the room's middle.
/// \param ways 2 for an eight, 1 for an ellipse
PathLine figureOfEight(Random& random, const Eigen::Vector2d& reach, int rounds, double ways)
{
  const double shift = random.uniform(0.0, 6.28);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= 48 * rounds; ++i) {
    const double angle = 2.0 * M_PI * i / 48.0;
    points.emplace_back(reach.x() * std::cos(angle + shift), reach.y() * std::sin(ways * (angle + shift)));
  }
  return {points, 0.3};
}

}  // namespace

World makeRoom(const WorldOptions& options)
{
  Random random(options.seed, 2);
  World world;
  const Eigen::Vector3d size(10.0, 8.0, 3.6);
  addRoomShell(world.still, random, size);
  addFurniture(world.still, random, size, 11);
  for (int i = 0; i < 8; ++i) {
    const double angle = M_PI / 4.0 * i + random.uniform(-0.15, 0.15);
    addTripod(world.still, random, upright(4.1 * std::cos(angle), 3.1 * std::sin(angle), 0.0));
  }
  const Terrain floor;
  DriveStyle style;
  style.speed = 1.0;
  const BodyStyle robot{0.6, 0.5, 0.003, 0.002};
  Random own = randomOfPath(options, random);
  const PathLine way = figureOfEight(own, {2.2, 1.5}, 4, options.path % 2 == 0 ? 1.0 : 2.0);
  world.sensor_motion = drive(way, style, robot, floor, own);
  random = options.path == 1 ? own : random;
  world.acceleration = 2.0;
  std::vector<Eigen::Vector2d> round;
  for (int i = 0; i < 60; ++i) {
    const double angle = M_PI / 4.0 * i;
    round.emplace_back(3.3 * std::cos(angle), 2.5 * std::sin(angle));
  }
  MovingObject person{{}, drive(PathLine(round, 0.8), style, BodyStyle(), floor, random), 0.5};
  addPerson(person.shape, random, SE3());
  world.moving.push_back(person);
  return world;
}

}  // namespace pcl_floam::simulator
