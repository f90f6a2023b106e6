#include "path_line.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_floam::simulator {

namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Points \p step apart along a polyline, its end included.
Points resample(const Points& line, double step)
{
  Points result{line.front()};
  double rest = step;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector2d leg = line[i] - line[i - 1];
    const double length = leg.norm();
    double done = 0.0;
    while (length - done >= rest) {
      done += rest;
      rest = step;
      result.push_back(line[i - 1] + leg * (done / length));
    }
    rest -= length - done;
  }
  return result;
}

/// The mean of each point's neighbours up to \p half places away; fewer near the ends, which stay where they are.
Points movingMean(const Points& line, std::size_t half)
{
  Points result(line.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::size_t reach = std::min({half, i, line.size() - 1 - i});
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t k = i - reach; k <= i + reach; ++k) {
      sum += line[k];
    }
    result[i] = sum / static_cast<double>(2 * reach + 1);
  }
  return result;
}

}  // namespace

PathLine::PathLine(const std::vector<Eigen::Vector2d>& waypoints, double rounding) : points_(resample(waypoints, kStep))
{
  // Three means make a kernel that is smooth twice over: the curvature has no jumps.
  const auto half = static_cast<std::size_t>(rounding / kStep / 2.0);
  for (int pass = 0; pass < 3 && half > 0; ++pass) {
    points_ = movingMean(points_, half);
  }
  points_ = resample(points_, kStep);
  double previous = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector2d along = points_[std::min(i + 1, points_.size() - 1)] - points_[i > 0 ? i - 1 : 0];
    const double direction = std::atan2(along.y(), along.x());
    const double wrapped = i == 0 ? direction : previous + std::remainder(direction - previous, 2.0 * M_PI);
    headings_.push_back(wrapped);
    previous = wrapped;
  }
}

double PathLine::length() const
{
  return kStep * static_cast<double>(points_.size() - 1);
}

Eigen::Vector2d PathLine::at(double station, double left) const
{
  const double place = station / kStep;
  const double last = static_cast<double>(points_.size() - 2);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, last));
  const double direction = heading(station);
  return points_[i] + (points_[i + 1] - points_[i]) * (place - static_cast<double>(i)) +
         left * Eigen::Vector2d(-std::sin(direction), std::cos(direction));
}

double PathLine::heading(double station) const
{
  const double place = std::clamp(station / kStep, 0.0, static_cast<double>(points_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), points_.size() - 2);
  return headings_[i] + (headings_[i + 1] - headings_[i]) * (place - static_cast<double>(i));
}

double PathLine::curvature(double station) const
{
  return (heading(station + kStep) - heading(station - kStep)) / (2.0 * kStep);
}

}  // namespace pcl_floam::simulator
