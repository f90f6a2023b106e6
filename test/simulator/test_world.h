/// \file test_world.h
/// The worlds that the odometry is tested in.
#pragma once

#include "simulation.h"

#include <string>

namespace pcl_floam::simulator {

/// A world of the family that settings are not chosen by.
/// \param sensor empty: the world's usual one
inline SimulationOptions testWorld(const std::string& world, const std::string& sensor = "")
{
  SimulationOptions options;
  options.world = world;
  options.sensor = sensor;
  options.family = Family::test;
  return options;
}

}  // namespace pcl_floam::simulator
