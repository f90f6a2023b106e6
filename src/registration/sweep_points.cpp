#include "registration/sweep_points.h"

#include "common/multi_version.h"

#include <algorithm>
#include <array>

namespace pcl_floam {

namespace {

constexpr std::size_t kAtOnce = 32;

/// Of some points, or of one for all.
template <typename T>
struct Three {
  T x, y, z;
};
using Column = std::array<double, kAtOnce>;

struct Motion {
  Three<double> velocity, half_acceleration, turn, half_turn_acceleration;
};

inline Three<double> cross(const Three<double>& a, const Three<double>& b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Three<double> operator+(const Three<double>& a, const Three<double>& b)
{
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Three<double> operator*(double s, const Three<double>& a)
{
  return {s * a.x, s * a.y, s * a.z};
}

Three<double> plain(const Eigen::Vector3d& v)
{
  return {v.x(), v.y(), v.z()};
}

/// The exponential's series to fourth order: half a sweep at a turn of 360 degrees a second leaves 3e-6 of the range.
/// \param since_middle in sweeps
PCL_FLOAM_MULTI_VERSION
void undistort(const Motion& motion, const Column& since_middle, Three<Column>& points)
{
  for (std::size_t n = 0; n < kAtOnce; ++n) {
    const double u = since_middle[n];
    const Three<double> p = {points.x[n], points.y[n], points.z[n]};
    const Three<double> turn = motion.turn + u * motion.half_turn_acceleration;
    const Three<double> first = u * (cross(turn, p) + motion.velocity + u * motion.half_acceleration);
    const Three<double> second = (0.5 * u) * cross(turn, first);
    const Three<double> third = (u / 3.0) * cross(turn, second);
    const Three<double> place = p + first + second + third + (0.25 * u) * cross(turn, third);
    points.x[n] = place.x;
    points.y[n] = place.y;
    points.z[n] = place.z;
  }
}

}  // namespace

void MovingSensor::undistorted(const ScanPoint* points, std::size_t stride, std::size_t count,
                               Eigen::Vector3d* places) const
{
  const Motion motion = {plain(velocity_), plain(half_acceleration_), plain(turn_), plain(half_turn_acceleration_)};
  Column since_middle{};
  Three<Column> some{};
  for (std::size_t begin = 0; begin < count; begin += kAtOnce) {
    const std::size_t n = std::min(kAtOnce, count - begin);
    for (std::size_t i = 0; i < n; ++i) {
      const ScanPoint& point = points[(begin + i) * stride];
      since_middle[i] = sinceMiddle(point);
      some.x[i] = static_cast<double>(point.x);
      some.y[i] = static_cast<double>(point.y);
      some.z[i] = static_cast<double>(point.z);
    }
    undistort(motion, since_middle, some);
    for (std::size_t i = 0; i < n; ++i) {
      places[begin + i] = {some.x[i], some.y[i], some.z[i]};
    }
  }
}

}  // namespace pcl_floam
