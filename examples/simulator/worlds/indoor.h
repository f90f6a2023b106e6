/// \file indoor.h
/// Rooms: their walls, and the clutter along them.
#pragma once

#include "../triangle_mesh.h"

namespace pcl_floam::simulator {

/// Adds a rectangular room centred on the origin, floor at 0, its walls with windows, doors and pillars.
/// \param size m
void addRoomShell(TriangleMesh& mesh, Random& random, const Eigen::Vector3d& size);

/// Adds tables, cabinets and shelves along the walls of a room, at odd angles.
/// \param count pieces of furniture
void addFurniture(TriangleMesh& mesh, Random& random, const Eigen::Vector3d& size, int count);

}  // namespace pcl_floam::simulator
