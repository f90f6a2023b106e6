/// \file world.h
/// The simulated places: what stands, what moves, and the path through them.
#pragma once

#include "drive.h"
#include "family.h"
#include "motion_spline.h"
#include "trajectory_file.h"
#include "triangle_mesh.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_floam::simulator {

/// Something that moves through a world.
struct MovingObject {
  TriangleMesh shape;  ///< in the object's frame: x forward, origin on the ground
  MotionSpline motion;
  double clearance = 1.0;  ///< m: nearer than this to the sensor it would be a collision
};

/// A place in which a sensor moves. The world's frame has z up; metres, radians.
struct World {
  TriangleMesh still;
  std::vector<MovingObject> moving;
  MotionSpline sensor_motion = MotionSpline(BodyState::Zero());  ///< world_T_sensor in time
  std::string default_sensor = "vlp16";
  double acceleration = 0.0;  ///< m/s^2, bound that the sensor's motion keeps to
};

/// How the sensor's motion begins.
enum class Begin {
  rest,  ///< stands, then picks up speed
  speed  ///< at full speed from the first scan
};

/// What the user can choose about a world.
struct WorldOptions {
  std::uint64_t seed = 1;
  bool smooth = false;  ///< corridor only: no doors, nothing that could tell how far one has come
  int path = 1;         ///< 1 is the usual way; 2, 3 ... are other ways through what stands there for the same seed
  bool truck = false;   ///< urban, highway: a lorry that drives beside the sensor and fills a third of its view
  Family family = Family::tune;
  Begin begin = Begin::rest;                   ///< open-road only
  std::optional<double> speed = std::nullopt;  ///< m/s, open-road only: instead of what the generator draws
  TrajectoryPart trajectory{};                 ///< town and motorway: the way; without a file one is drawn
};

/// Racks with posts and uneven loads, pillars, machines, walking workers; 330 m at up to 2 m/s.
[[nodiscard]] World makeWarehouse(const WorldOptions& options);

/// A motion-capture room of 10 x 8 m with furniture and a walking person; 60 s at walking pace.
[[nodiscard]] World makeRoom(const WorldOptions& options);

/// A garage: low ceiling with beams and pipes, columns alike, rows of parked cars, people; some 250 m at up to 3 m/s.
[[nodiscard]] World makeCarPark(const WorldOptions& options);

/// Streets with facades, trees, poles, parked and moving cars, slopes and crossings; a loop of more than 1 km.
[[nodiscard]] World makeUrban(const WorldOptions& options);

/// A motorway with guard rails, banks, a few signs and bridges, traffic; more than 1 km at 25 m/s.
[[nodiscard]] World makeHighway(const WorldOptions& options);

/// A road through open country: rolling ground, a low rail at one side, poles, trees and a few houses, traffic; more
/// than 900 m at about 25 m/s.
[[nodiscard]] World makeOpenRoad(const WorldOptions& options);

/// A town along a trajectory: facades behind front gardens, hedges, fences, trees, poles, parked and moving cars beside
/// real motion.
[[nodiscard]] World makeTown(const WorldOptions& options);

/// A motorway along a trajectory: barriers, ditches, banks, grass, dense bushes and trees, signs, traffic beside real
/// motion.
[[nodiscard]] World makeMotorway(const WorldOptions& options);

/// A yard or an open place: a few buildings far apart at its edge, parked vehicles, trees, poles, people; a round of
/// more than 100 m at up to 3 m/s.
[[nodiscard]] World makeYard(const WorldOptions& options);

/// A straight corridor, 130 m to go, with doors every 5 to 11 m as its only structure; no end in sight.
[[nodiscard]] World makeCorridor(const WorldOptions& options);

/// The corridor without doors: nothing tells how far one has come.
[[nodiscard]] World makeTunnel(const WorldOptions& options);

/// An office room; the sensor is swung by hand at up to 120 degrees a second about all axes.
[[nodiscard]] World makeHandheld(const WorldOptions& options);

/// A world by name.
/// \throws std::invalid_argument for an unknown name
[[nodiscard]] World makeWorld(std::string_view name, const WorldOptions& options);

/// The names that \ref makeWorld knows.
[[nodiscard]] const std::vector<std::string>& worldNames();

/// The random numbers that a world is made of.
/// \param purpose another one for each world
[[nodiscard]] Random randomOfWorld(const WorldOptions& options, std::uint64_t purpose);

/// The random numbers of a way through a world. The first way's are the world's own; the others leave those as they
/// are, so that what stands is the same.
[[nodiscard]] Random randomOfPath(const WorldOptions& options, const Random& world);

/// Takes out the moving objects that would run into the sensor.
void removeCollisions(World& world);

}  // namespace pcl_floam::simulator
