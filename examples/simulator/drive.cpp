#include "drive.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pcl_floam::simulator {

namespace {

constexpr double kInterval = 0.1;      // s between the spline's controls
constexpr double kStationStep = 0.25;  // m between samples of the speed limit
constexpr std::size_t kJerkHalf = 4;   // controls to each side over which changes of speed are spread

/// Highest speed allowed at each station, from bends, start and end, and what the acceleration can reach.
std::vector<double> speedLimits(const PathLine& line, const DriveStyle& style, double first, double last)
{
  const auto count = static_cast<std::size_t>((last - first) / kStationStep) + 1;
  std::vector<double> limits(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double bend = std::abs(line.curvature(first + kStationStep * static_cast<double>(i)));
    limits[i] = std::min(style.speed, std::sqrt(style.side_acceleration / std::max(bend, 1e-6)));
  }
  limits.front() = std::min(limits.front(), style.start_speed);
  limits.back() = std::min(limits.back(), style.end_speed);
  const double gain = 2.0 * style.acceleration * kStationStep;
  for (std::size_t i = 1; i < count; ++i) {
    limits[i] = std::min(limits[i], std::sqrt(limits[i - 1] * limits[i - 1] + gain));
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    limits[i] = std::min(limits[i], std::sqrt(limits[i + 1] * limits[i + 1] + gain));
  }
  return limits;
}

/// Station at each control's time.
std::vector<double> stationsInTime(const std::vector<double>& limits, double wait, double first, double last)
{
  std::vector<double> times{0.0};
  for (std::size_t i = 1; i < limits.size(); ++i) {
    times.push_back(times.back() + 2.0 * kStationStep / std::max(limits[i] + limits[i - 1], 1e-3));
  }
  std::vector<double> stations(static_cast<std::size_t>(std::lround(wait / kInterval)), first);
  std::size_t i = 0;
  for (double t = 0.0; t < times.back(); t += kInterval) {
    while (times[i + 1] <= t) {
      ++i;
    }
    // Within a step the square of the speed changes evenly.
    const double elapsed = t - times[i];
    const double rate = (limits[i + 1] - limits[i]) / (times[i + 1] - times[i]);
    stations.push_back(first + kStationStep * static_cast<double>(i) + elapsed * (limits[i] + 0.5 * rate * elapsed));
  }
  const double end_speed = limits.back();
  for (std::size_t k = 0; k < 3; ++k) {
    stations.push_back(end_speed > 0.0 ? stations.back() + end_speed * kInterval : last);
  }
  return stations;
}

/// Spreads changes of speed over about a second. Beyond the ends the speed there is kept.
std::vector<double> roundJerks(const std::vector<double>& stations)
{
  const auto at = [&stations](std::ptrdiff_t i) {
    const auto last = static_cast<std::ptrdiff_t>(stations.size()) - 1;
    if (i < 0) {
      return stations.front() + static_cast<double>(i) * (stations[1] - stations[0]);
    }
    if (i > last) {
      return stations.back() + static_cast<double>(i - last) * (stations.back() - stations[stations.size() - 2]);
    }
    return stations[static_cast<std::size_t>(i)];
  };
  std::vector<double> result;
  const auto half = static_cast<std::ptrdiff_t>(kJerkHalf);
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(stations.size()); ++i) {
    double sum = 0.0;
    for (std::ptrdiff_t k = -half; k <= half; ++k) {
      sum += at(i + k);
    }
    result.push_back(sum / static_cast<double>(2 * half + 1));
  }
  return result;
}

/// Height, pitch and roll of a body whose wheels stand on the terrain.
void standOn(const Terrain& terrain, double wheel_base, BodyState& state)
{
  if (wheel_base <= 0.0) {
    state[2] = terrain.height(state[0], state[1]);
    return;
  }
  const double half = 0.5 * wheel_base;
  const Eigen::Vector2d ahead(half * std::cos(state[3]), half * std::sin(state[3]));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const double front = terrain.height(state[0] + ahead.x(), state[1] + ahead.y());
  const double rear = terrain.height(state[0] - ahead.x(), state[1] - ahead.y());
  const double port = terrain.height(state[0] + left.x(), state[1] + left.y());
  const double starboard = terrain.height(state[0] - left.x(), state[1] - left.y());
  state[2] = 0.25 * (front + rear + port + starboard);
  state[4] = -std::atan2(front - rear, wheel_base);
  state[5] = std::atan2(port - starboard, wheel_base);
}

}  // namespace

MotionSpline drive(const PathLine& line, const DriveStyle& style, const BodyStyle& body, const Terrain& terrain,
                   Random& random)
{
  const double last = std::min(style.last_station, line.length());
  const std::vector<double> limits = speedLimits(line, style, style.first_station, last);
  const std::vector<double> stations = roundJerks(stationsInTime(limits, style.wait, style.first_station, last));
  const SmoothNoise pitch(random, body.sway, 0.4, 2.0);
  const SmoothNoise roll(random, body.sway, 0.4, 2.0);
  const SmoothNoise bounce(random, body.bounce, 0.5, 2.0);
  std::vector<BodyState> controls;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double t = kInterval * static_cast<double>(i);
    BodyState state = BodyState::Zero();
    state.head<2>() = line.at(stations[i], style.left);
    state[3] = line.heading(stations[i]);
    standOn(terrain, body.wheel_base, state);
    state[2] += body.height + bounce(t);
    state[4] += pitch(t);
    state[5] += roll(t);
    controls.push_back(state);
  }
  return MotionSpline(kInterval, controls);
}

}  // namespace pcl_floam::simulator
