#include "objects.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

/// A pose tilted from the vertical by \p lean rad towards \p direction rad.
SE3 leaning(const Eigen::Vector3d& foot, double lean, double direction)
{
  const Eigen::Vector3d axis(-std::sin(direction), std::cos(direction), 0.0);
  return {Eigen::AngleAxisd(lean, axis).toRotationMatrix(), foot};
}

/// A wheel: a short cylinder on its side, its axis along the vehicle's y.
void addWheel(TriangleMesh& mesh, const SE3& world_T_vehicle, double x, double y, double radius)
{
  const SE3 vehicle_T_wheel(Eigen::AngleAxisd(-M_PI / 2.0, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                            Eigen::Vector3d(x, y - 0.1, radius));
  addCylinder(mesh, world_T_vehicle * vehicle_T_wheel, radius, 0.2, 0.1, 1.0, 10);
}

}  // namespace

void addCar(TriangleMesh& mesh, Random& random, const SE3& world_T_car)
{
  const double paint = random.uniform(0.15, 0.8);
  const double length = random.uniform(3.9, 4.7);
  const double width = random.uniform(1.7, 1.9);
  const std::size_t body = mesh.triangles.size();
  addBox(mesh, world_T_car * upright(0.0, 0.0, 0.25), {length, width, 0.3}, paint, 1.02);
  addBox(mesh, world_T_car * upright(0.0, 0.0, 0.55), {1.02 * length, 1.02 * width, 0.35}, paint, 0.95);
  polish(mesh, body, kPaintGloss);
  const std::size_t cabin = mesh.triangles.size();
  addBox(mesh, world_T_car * upright(-0.25, 0.0, 0.9), {0.62 * length, 0.92 * width, random.uniform(0.5, 0.65)}, 0.25,
         0.76);
  polish(mesh, cabin, kGlassGloss);
  for (const double x : {-0.31 * length, 0.31 * length}) {
    for (const double y : {-0.46 * width, 0.46 * width}) {
      addWheel(mesh, world_T_car, x, y, 0.32);
    }
  }
}

void addTruck(TriangleMesh& mesh, Random& random, const SE3& world_T_truck)
{
  addBox(mesh, world_T_truck * upright(4.7, 0.0, 0.5), {2.2, 2.4, 2.5}, random.uniform(0.2, 0.8), 0.94);
  addBox(mesh, world_T_truck * upright(-1.3, 0.0, 1.1), {9.4, 2.5, 2.7}, random.uniform(0.3, 0.8));
  addBox(mesh, world_T_truck * upright(0.0, 0.0, 0.6), {11.0, 1.0, 0.4}, 0.15);
  for (const double x : {-5.0, -3.8, 2.5, 4.7}) {
    addWheel(mesh, world_T_truck, x, -1.1, 0.5);
    addWheel(mesh, world_T_truck, x, 1.1, 0.5);
  }
}

void addPerson(TriangleMesh& mesh, Random& random, const SE3& world_T_person)
{
  const double scale = random.uniform(0.92, 1.08);
  const double clothes = random.uniform(0.2, 0.7);
  const double stride = random.uniform(0.05, 0.35);
  for (const double side : {-0.1, 0.1}) {
    const SE3 leg = leaning({side > 0.0 ? stride : -stride, side, 0.0}, side > 0.0 ? -stride : stride, 0.0);
    addCylinder(mesh, world_T_person * leg, 0.07 * scale, 0.85 * scale, 0.3, 1.2, 8);
    const SE3 arm = leaning({0.0, 2.4 * side, 0.85 * scale}, 0.15, side > 0.0 ? -1.57 : 1.57);
    addCylinder(mesh, world_T_person * arm, 0.05, 0.6 * scale, clothes, 1.0, 6);
  }
  addCylinder(mesh, world_T_person * upright(0.0, 0.0, 0.8 * scale), 0.15, 0.65 * scale, clothes, 1.25, 10);
  addCylinder(mesh, world_T_person * upright(0.0, 0.0, 1.45 * scale), 0.09, 0.28 * scale, 0.5, 0.8, 10);
}

void addTree(TriangleMesh& mesh, Random& random, const SE3& world_T_tree)
{
  const double height = random.uniform(2.2, 3.2);
  const double radius = random.uniform(0.1, 0.22);
  const SE3 trunk = leaning(Eigen::Vector3d(0.0, 0.0, -0.2), random.uniform(0.0, 0.08), random.uniform(0.0, 6.28));
  addCylinder(mesh, world_T_tree * trunk, radius, height, 0.3, 0.75, 10);
  const SE3 fork = trunk * upright(0.0, 0.0, height - 0.1);
  for (int i = 0; i < 5; ++i) {
    const SE3 branch = leaning(Eigen::Vector3d::Zero(), random.uniform(0.3, 0.8), 1.257 * i + random.uniform());
    addCylinder(mesh, world_T_tree * fork * branch, 0.4 * radius, random.uniform(1.5, 2.6), 0.3, 0.4, 6);
  }
  const double crown = random.uniform(1.6, 2.6);
  const SE3 middle = fork * upright(0.0, 0.0, 0.75 * crown);
  addFoliage(mesh, random, world_T_tree * middle, {crown, crown, 1.1 * crown}, 0.18, 450, 0.45);
}

void addLamp(TriangleMesh& mesh, const SE3& world_T_lamp, double height)
{
  addCylinder(mesh, world_T_lamp * upright(0.0, 0.0, -0.2), 0.09, height + 0.2, 0.45, 0.6, 10);
  addBox(mesh, world_T_lamp * upright(0.8, 0.0, height - 0.15), {1.8, 0.15, 0.12}, 0.45);
}

void addSign(TriangleMesh& mesh, Random& random, const SE3& world_T_sign)
{
  const double height = random.uniform(2.1, 2.6);
  addCylinder(mesh, world_T_sign * upright(0.0, 0.0, -0.2), 0.035, height + 0.5, 0.5, 1.0, 8);
  addBox(mesh, world_T_sign * upright(0.05, 0.0, height - 0.3), {0.02, random.uniform(0.5, 0.8), 0.6}, 0.95);
}

void addMachine(TriangleMesh& mesh, Random& random, const SE3& world_T_machine)
{
  addBox(mesh, world_T_machine * upright(0.0, 0.0, 0.0), {random.uniform(1.6, 2.4), random.uniform(0.9, 1.5), 0.9},
         random.uniform(0.3, 0.6));
  for (int i = 0; i < 4; ++i) {
    const SE3 place = upright(random.uniform(-0.9, 0.9), random.uniform(-0.5, 0.5), 0.0, random.uniform(-0.4, 0.4));
    const Eigen::Vector3d size(random.uniform(0.3, 0.9), random.uniform(0.3, 0.7), random.uniform(1.1, 2.2));
    addBox(mesh, world_T_machine * place, size, random.uniform(0.2, 0.7), random.uniform(0.7, 1.0));
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d foot(random.uniform(-1.2, 1.2), random.uniform(-0.8, 0.8), 0.0);
    const SE3 pipe = leaning(foot, random.uniform(0.0, 0.3), random.uniform(0.0, 6.28));
    addCylinder(mesh, world_T_machine * pipe, random.uniform(0.05, 0.2), random.uniform(1.5, 2.5), 0.5);
  }
}

void addTable(TriangleMesh& mesh, Random& random, const SE3& world_T_table, const Eigen::Vector3d& size)
{
  addBox(mesh, world_T_table * upright(0.0, 0.0, size.z() - 0.04), {size.x(), size.y(), 0.04}, 0.6);
  for (const double x : {-0.45, 0.45}) {
    for (const double y : {-0.43, 0.43}) {
      addBox(mesh, world_T_table * upright(x * size.x(), y * size.y(), 0.0), {0.05, 0.05, size.z()}, 0.4);
    }
  }
  for (int i = 0; i < 3; ++i) {
    const SE3 place = upright(random.uniform(-0.35, 0.35) * size.x(), random.uniform(-0.3, 0.3) * size.y(), size.z(),
                              random.uniform(-1.0, 1.0));
    addBox(mesh, world_T_table * place, {random.uniform(0.1, 0.5), random.uniform(0.05, 0.3), random.uniform(0.1, 0.5)},
           random.uniform(0.1, 0.8));
  }
}

void addTripod(TriangleMesh& mesh, Random& random, const SE3& world_T_tripod)
{
  const double height = random.uniform(1.5, 2.2);
  const double spread = 0.25;
  for (int i = 0; i < 3; ++i) {
    const double direction = 2.0944 * i + 0.4;
    const Eigen::Vector3d foot(0.4 * std::cos(direction), 0.4 * std::sin(direction), 0.0);
    addCylinder(mesh, world_T_tripod * leaning(foot, -spread, direction), 0.02, 1.5, 0.3, 1.0, 6);
  }
  addCylinder(mesh, world_T_tripod * upright(0.0, 0.0, 1.2), 0.025, height - 1.2, 0.3, 1.0, 6);
  addBox(mesh, world_T_tripod * upright(0.0, 0.0, height, random.uniform(0.0, 6.28)), {0.12, 0.1, 0.12}, 0.2);
}

}  // namespace pcl_floam::simulator
