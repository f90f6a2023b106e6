#include "road.h"

#include "../objects.h"

#include <algorithm>

namespace pcl_floam::simulator {

std::pair<double, double> extentAcross(const PathLine& line)
{
  std::pair<double, double> extent(line.at(0.0).y(), line.at(0.0).y());
  for (double station = 0.0; station < line.length(); station += 10.0) {
    const double y = line.at(station).y();
    extent = {std::min(extent.first, y), std::max(extent.second, y)};
  }
  return extent;
}

PathLine reversed(const PathLine& line)
{
  std::vector<Eigen::Vector2d> points;
  for (double station = line.length(); station >= 0.0; station -= 5.0) {
    points.push_back(line.at(station));
  }
  return {points, 4.0};
}

SE3 besideRoad(const PathLine& line, const Terrain& terrain, double station, double left, double turn)
{
  const Eigen::Vector2d place = line.at(station, left);
  return upright(place.x(), place.y(), terrain.height(place.x(), place.y()), line.heading(station) + turn);
}

DriveStyle cruising(double speed, double left, double first_station)
{
  DriveStyle style;
  style.speed = style.start_speed = style.end_speed = speed;
  style.side_acceleration = 3.5;
  style.left = left;
  style.first_station = first_station;
  return style;
}

void addVehicle(World& world, Random& random, const PathLine& line, const Terrain& terrain, const DriveStyle& style,
                double lorries)
{
  MovingObject vehicle{{}, drive(line, style, {0.0, 2.6, 0.0, 0.0}, terrain, random), 3.0};
  if (random.chance(lorries)) {
    addTruck(vehicle.shape, random, SE3());
  } else {
    addCar(vehicle.shape, random, SE3());
  }
  world.moving.push_back(vehicle);
}

}  // namespace pcl_floam::simulator
