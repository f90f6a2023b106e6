#include "common/sweep_trajectory.h"

#include "common/multi_version.h"

namespace pcl_floam {

namespace {

struct Three {
  double x, y, z;
};

struct Motion {
  Three velocity, half_acceleration, turn, half_turn_acceleration;
};

inline Three cross(const Three& a, const Three& b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Three operator+(const Three& a, const Three& b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Three operator*(double s, const Three& a)
{
  return {s * a.x, s * a.y, s * a.z};
}

Three plain(const Vector6& v, Eigen::Index first)
{
  return {v[first], v[first + 1], v[first + 2]};
}

/// The exponential's series up to some order.
PCL_FLOAM_MULTI_VERSION
void addOrders(int orders, const Motion motion, SweepTrajectory::Batch& points, SweepTrajectory::Batch& term)
{
  for (int order = 1; order <= orders; ++order) {
    const double part = 1.0 / order;
    const double moved = order == 1 ? 1.0 : 0.0;
    for (std::size_t n = 0; n < SweepTrajectory::Batch::kMost; ++n) {
      const double u = points.since[n];
      const Three turn = motion.turn + u * motion.half_turn_acceleration;
      const Three velocity = motion.velocity + u * motion.half_acceleration;
      const Three next = (u * part) * (cross(turn, {term.x[n], term.y[n], term.z[n]}) + moved * velocity);
      term.x[n] = next.x;
      term.y[n] = next.y;
      term.z[n] = next.z;
    }
    for (std::size_t n = 0; n < SweepTrajectory::Batch::kMost; ++n) {
      points.x[n] += term.x[n];
      points.y[n] += term.y[n];
      points.z[n] += term.z[n];
    }
  }
}

/// Whose rest is nothing, as part of the range, or of a metre if that is less.
/// \param turn  rad, from the reference instant to the farther end of the sweep
/// \param shift m, alike
int ordersOf(double turn, double shift)
{
  constexpr double kNothing = 1e-7;
  constexpr int kMost = 100;  // of 30 rad: no lidar turns as far
  int orders = 1;
  for (double rest = 0.5 * turn * (turn + shift); rest > kNothing && orders < kMost; rest *= turn / (orders + 1)) {
    ++orders;
  }
  return orders;
}

}  // namespace

SweepTrajectory::SweepTrajectory(const SE3& target_T_sensor, const Vector6& twist, double reference,
                                 const Vector6& acceleration)
    : pose_(target_T_sensor), twist_(twist), acceleration_(acceleration), reference_(reference)
{
  const double longest = std::max(reference, 1.0 - reference);
  const Vector6 farthest = longest * (twist.cwiseAbs() + 0.5 * longest * acceleration.cwiseAbs());
  orders_ = ordersOf(farthest.tail<3>().norm(), farthest.head<3>().norm());
}

void SweepTrajectory::undistort(Batch& points) const
{
  const Vector6 half = 0.5 * acceleration_;
  const Motion motion = {plain(twist_, 0), plain(half, 0), plain(twist_, 3), plain(half, 3)};
  Batch term = points;
  addOrders(orders_, motion, points, term);
}

SweepTrajectory SweepTrajectory::perturbed(const Vector6& delta) const
{
  SE3 pose = exp(delta) * pose_;
  pose.rotation = nearestRotation(pose.rotation);
  return SweepTrajectory(pose, twist_, reference_, acceleration_);
}

}  // namespace pcl_floam
