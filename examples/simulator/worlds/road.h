/// \file road.h
/// What all open roads have in common: places beside them, and vehicles that drive steadily along them.
#pragma once

#include "../drive.h"
#include "../world.h"

#include <utility>

namespace pcl_floam::simulator {

/// Least and greatest y of a line, m.
[[nodiscard]] std::pair<double, double> extentAcross(const PathLine& line);

/// The line driven the other way.
[[nodiscard]] PathLine reversed(const PathLine& line);

/// A pose on the ground beside the road, x along it.
/// \param left m from the road's line
/// \param turn rad, added to the road's heading
[[nodiscard]] SE3 besideRoad(const PathLine& line, const Terrain& terrain, double station, double left,
                             double turn = 0.0);

/// Steady driving: no bend of the road is tight enough to slow down for.
[[nodiscard]] DriveStyle cruising(double speed, double left, double first_station);

/// Adds a vehicle in traffic, a lorry with the given probability, else a car.
void addVehicle(World& world, Random& random, const PathLine& line, const Terrain& terrain, const DriveStyle& style,
                double lorries);

}  // namespace pcl_floam::simulator
