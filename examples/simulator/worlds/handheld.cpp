#include "../objects.h"
#include "../world.h"
#include "indoor.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kControlInterval = 0.1;            // s between the spline's controls
constexpr double kDuration = 60.0;                  // s
constexpr double kPeakRate = 120.0 * M_PI / 180.0;  // rad/s

/// Greatest angular velocity of a motion about any axis, rad/s.
double peakRate(const MotionSpline& motion)
{
  constexpr double kStep = 0.02;  // s
  double peak = 0.0;
  for (double t = 0.0; t + kStep < motion.duration(); t += kStep) {
    const SE3 between = motion.pose(t).inverse() * motion.pose(t + kStep);
    peak = std::max(peak, rotationAngle(between.rotation) / kStep);
  }
  return peak;
}

/// A sensor that is carried about and swung in all directions. It is lifted from rest within two seconds.
/// \param swing factor on all angles
MotionSpline swing(const WorldOptions& options, double swing)
{
  Random random = randomOfPath(options, Random(options.seed, 61));
  const SmoothNoise x(random, 1.0, 0.04, 0.12, 3);
  const SmoothNoise y(random, 0.7, 0.04, 0.12, 3);
  const SmoothNoise shake_x(random, 0.03, 0.5, 1.1);
  const SmoothNoise shake_y(random, 0.03, 0.5, 1.1);
  const SmoothNoise z(random, 0.06, 0.2, 0.8);
  const SmoothNoise yaw(random, 1.0, 0.1, 0.35, 4);
  const SmoothNoise pitch(random, 0.3, 0.25, 0.7, 4);
  const SmoothNoise roll(random, 0.3, 0.25, 0.7, 4);
  std::vector<BodyState> controls;
  for (double t = 0.0; t < kDuration + 3.0 * kControlInterval; t += kControlInterval) {
    const double part = std::clamp(0.5 * (t - 0.3), 0.0, 1.0);
    const double lifted = part * part * part * (10.0 - 15.0 * part + 6.0 * part * part);
    BodyState state;
    state << x(t) + shake_x(t), y(t) + shake_y(t), z(t), swing * yaw(t), swing * pitch(t), swing * roll(t);
    BodyState rest;
    rest << x(0.0) + shake_x(0.0), y(0.0) + shake_y(0.0), z(0.0), swing * yaw(0.0), 0.0, 0.0;
    controls.push_back(rest + lifted * (state - rest));
    controls.back()[2] += 1.4;
  }
  return {kControlInterval, controls};
}

/// The swing whose fastest moment has the wanted angular velocity.
MotionSpline swingAtPeakRate(const WorldOptions& options)
{
  double factor = 1.0;
  for (int i = 0; i < 4; ++i) {
    factor *= kPeakRate / peakRate(swing(options, factor));
  }
  return swing(options, factor);
}

}  // namespace

World makeHandheld(const WorldOptions& options)
{
  Random random(options.seed, 6);
  World world;
  const Eigen::Vector3d size(12.0, 9.0, 3.2);
  addRoomShell(world.still, random, size);
  addFurniture(world.still, random, size, 14);
  for (int i = 0; i < 4; ++i) {
    const SE3 place = upright(i < 2 ? -3.6 : 3.6, i % 2 == 0 ? -2.2 : 2.2, 0.0, random.uniform(0.0, 3.0));
    addTable(world.still, random, place, {1.4, 0.7, 0.75});
  }
  world.sensor_motion = swingAtPeakRate(options);
  world.acceleration = 5.0;
  return world;
}

}  // namespace pcl_floam::simulator
