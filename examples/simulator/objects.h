/// \file objects.h
/// Things that several worlds have: cars, people, trees, lamps, furniture.
#pragma once

#include "triangle_mesh.h"

namespace pcl_floam::simulator {

/// Adds a passenger car, about 4.4 x 1.8 x 1.5 m; x forward, its frame on the ground at its middle.
void addCar(TriangleMesh& mesh, Random& random, const SE3& world_T_car);

/// Adds a lorry with its trailer, about 12 x 2.5 x 3.8 m.
void addTruck(TriangleMesh& mesh, Random& random, const SE3& world_T_truck);

/// Adds a standing or walking person, about 1.75 m tall.
void addPerson(TriangleMesh& mesh, Random& random, const SE3& world_T_person);

/// Adds a tree 6 to 10 m tall with a leaning trunk and loose leaves.
void addTree(TriangleMesh& mesh, Random& random, const SE3& world_T_tree);

/// Adds a street lamp; its arm points along x.
void addLamp(TriangleMesh& mesh, const SE3& world_T_lamp, double height);

/// Adds a traffic sign; its face looks along x.
void addSign(TriangleMesh& mesh, Random& random, const SE3& world_T_sign);

/// Adds a machine: a few boxes, cylinders and pipes within about 3 x 2 x 2.5 m.
void addMachine(TriangleMesh& mesh, Random& random, const SE3& world_T_machine);

/// Adds a table of the given size with four legs and things on it.
void addTable(TriangleMesh& mesh, Random& random, const SE3& world_T_table, const Eigen::Vector3d& size);

/// Adds a tripod as it carries cameras, 1.5 to 2.2 m tall.
void addTripod(TriangleMesh& mesh, Random& random, const SE3& world_T_tripod);

}  // namespace pcl_floam::simulator
