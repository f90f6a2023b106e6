#include "way.h"

#include "road.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace pcl_floam::simulator {

namespace {

constexpr double kPoseInterval = 0.1;  // s between the poses of a trajectory

/// A drive along straight legs with bends between them.
std::vector<BodyState> drawStates(const DrawnWay& drawn, double length, Random& random)
{
  std::vector<Eigen::Vector2d> points{Eigen::Vector2d::Zero()};
  double heading = 0.0;
  for (double gone = 0.0; gone < length;) {
    const double leg = drawn.leg * random.uniform(0.6, 1.4);
    points.emplace_back(points.back() + leg * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
    // Bends to both sides in turn do not lead back to where the way has been.
    heading = heading > 0.0 ? -random.uniform(0.0, drawn.bend) : random.uniform(0.2, 1.0) * drawn.bend;
    gone += leg;
  }
  Terrain terrain;
  terrain.addWaves(random, drawn.climb, 200.0, 500.0);
  const PathLine line(points, std::min(0.1 * drawn.leg, 12.0));
  DriveStyle style;
  style.speed = drawn.speed;
  style.start_speed = 0.5 * drawn.speed;
  style.acceleration = 1.5;
  style.side_acceleration = 2.2;
  style.last_station = length;
  const MotionSpline motion = drive(line, style, {kLidarHeight, 2.6, 0.004, 0.006}, terrain, random);
  std::vector<BodyState> states;
  for (double t = 0.0; t <= motion.duration(); t += kPoseInterval) {
    states.push_back(motion.state(t));
  }
  return states;
}

/// Places on the ground below the states, at least \p apart from one to the next.
std::vector<Eigen::Vector3d> groundBelow(const std::vector<BodyState>& states, double apart)
{
  std::vector<Eigen::Vector3d> ground;
  for (const BodyState& state : states) {
    const Eigen::Vector3d below = poseOf(state) * Eigen::Vector3d(0.0, 0.0, -kLidarHeight);
    if (ground.empty() || (below - ground.back()).head<2>().norm() >= apart) {
      ground.push_back(below);
    }
  }
  return ground;
}

/// The ground goes on before and behind.
std::vector<Eigen::Vector3d> prolonged(std::vector<Eigen::Vector3d> ground, double length)
{
  const Eigen::Vector3d back = (ground[0] - ground[1]).normalized();
  const Eigen::Vector3d ahead = (ground[ground.size() - 1] - ground[ground.size() - 2]).normalized();
  std::vector<Eigen::Vector3d> all;
  for (double gone = length; gone > 0.0; gone -= 3.0) {
    all.emplace_back(ground.front() + gone * back);
  }
  all.insert(all.end(), ground.begin(), ground.end());
  for (double gone = 3.0; gone < length; gone += 3.0) {
    all.emplace_back(ground.back() + gone * ahead);
  }
  return all;
}

}  // namespace

Way makeWay(const WorldOptions& options, const DrawnWay& drawn, Random& random, const CrossSection& section)
{
  constexpr double kBeyond = 60.0;  // m of road before and behind the way
  std::vector<BodyState> states = options.trajectory.file.empty()
                                      ? drawStates(drawn, std::min(options.trajectory.length, 400.0), random)
                                      : readTrajectoryPart(options.trajectory);
  const std::vector<Eigen::Vector3d> ground = prolonged(groundBelow(states, 2.0), kBeyond);
  std::vector<Eigen::Vector2d> places;
  for (const Eigen::Vector3d& place : ground) {
    places.emplace_back(place.head<2>());
  }
  const auto raster = std::make_shared<const HeightRaster>(ground, drawn.reach, section);
  Terrain terrain;
  terrain.layOn(raster);
  if (options.path > 1) {
    Random own = randomOfPath(options, random);
    const double left = (options.path % 2 == 0 ? -1.0 : 1.0) * own.uniform(0.3, 0.6);
    for (BodyState& state : states) {
      state.head<2>() += left * Eigen::Vector2d(-std::sin(state[3]), std::cos(state[3]));
    }
  }
  return {PathLine(places, 2.0), MotionSpline(kPoseInterval, states), terrain, places, *raster};
}

bool isClear(const Way& way, const Eigen::Vector2d& place, double distance)
{
  return std::all_of(way.places.begin(), way.places.end(), [&place, distance](const Eigen::Vector2d& one) {
    return (one - place).squaredNorm() > distance * distance;
  });
}

void addGroundAlong(TriangleMesh& mesh, const Way& way, double reflectivity)
{
  const HeightRaster& raster = way.raster;
  const auto at = [&way](const Eigen::Vector2d& place) {
    return Eigen::Vector3d(place.x(), place.y(), way.terrain.height(place.x(), place.y()));
  };
  const double step = HeightRaster::step();
  for (std::size_t i = 0; i + 1 < raster.columns(); ++i) {
    for (std::size_t k = 0; k + 1 < raster.rows(); ++k) {
      if (raster.covers(i, k)) {
        const Eigen::Vector2d corner = raster.corner(i, k);
        addQuad(mesh,
                {at(corner), at(corner + Eigen::Vector2d(step, 0.0)), at(corner + Eigen::Vector2d(step, step)),
                 at(corner + Eigen::Vector2d(0.0, step))},
                reflectivity);
      }
    }
  }
}

SE3 besideWay(const Way& way, double station, double left, double turn)
{
  return besideRoad(way.line, way.terrain, station, left, turn);
}

}  // namespace pcl_floam::simulator
