#include "indoor.h"

#include "../objects.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

/// One wall: windows in bays between pillars, one bay a door.
Relief roomWall(Random& random, double length, double height)
{
  const int bays = std::max(2, static_cast<int>(length / random.uniform(2.2, 3.2)));
  const double bay = length / bays;
  std::vector<double> columns{0.0};
  for (int i = 0; i < bays; ++i) {
    columns.insert(columns.end(),
                   {(i + 0.1) * bay, (i + 0.3) * bay, (i + 0.72) * bay, (i + 0.9) * bay, (i + 1.0) * bay});
  }
  const double lintel = std::min(2.1, 0.75 * height);
  Relief relief(columns, {0.0, 0.1, 0.9, lintel, height}, {0.0, 0.6});
  const int door = random.index(bays);
  for (int i = 0; i < bays; ++i) {
    const auto first = static_cast<std::size_t>(5 * i);
    const bool pillar = random.chance(0.6);
    const bool window = random.chance(0.6);
    for (std::size_t row = 0; row < 4; ++row) {
      relief.cell(row, first).depth = pillar ? 0.15 : 0.0;
      relief.cell(row, first + 4).depth = pillar ? 0.15 : 0.0;
    }
    relief.cell(2, first + 2) = window ? ReliefCell{-0.18, 0.35, kGlassGloss} : ReliefCell{0.0, 0.6};
    if (i == door) {
      for (std::size_t row = 0; row < 3; ++row) {
        relief.cell(row, first + 2) = {-0.1, 0.5};
      }
    }
  }
  return relief;
}

}  // namespace

void addRoomShell(TriangleMesh& mesh, Random& random, const Eigen::Vector3d& size)
{
  const Eigen::Vector3d half = 0.5 * size;
  addRelief(mesh, upright(-half.x(), -half.y(), 0.0, 0.0), roomWall(random, size.x(), size.z()));
  addRelief(mesh, upright(half.x(), -half.y(), 0.0, M_PI / 2.0), roomWall(random, size.y(), size.z()));
  addRelief(mesh, upright(half.x(), half.y(), 0.0, M_PI), roomWall(random, size.x(), size.z()));
  addRelief(mesh, upright(-half.x(), half.y(), 0.0, -M_PI / 2.0), roomWall(random, size.y(), size.z()));
  for (const double z : {0.0, size.z()}) {
    const double x = half.x() + 0.5;
    const double y = half.y() + 0.5;
    addQuad(
        mesh,
        {Eigen::Vector3d(-x, -y, z), Eigen::Vector3d(x, -y, z), Eigen::Vector3d(x, y, z), Eigen::Vector3d(-x, y, z)},
        z > 0.0 ? 0.7 : 0.35);
  }
  for (double x = -half.x() + 1.5; x < half.x(); x += 2.5) {
    addBox(mesh, upright(x, 0.0, size.z() - 0.25), {0.25, 0.8 * size.y(), 0.15}, 0.6);
  }
}

void addFurniture(TriangleMesh& mesh, Random& random, const Eigen::Vector3d& size, int count)
{
  const double perimeter = 2.0 * (size.x() + size.y());
  for (int i = 0; i < count; ++i) {
    // Walk round the walls, an even share of them for each piece.
    double place = perimeter * (i + random.uniform(0.2, 0.8)) / count;
    const bool side = place > size.x() + size.y();
    place -= side ? size.x() + size.y() : 0.0;
    const bool along_x = place < size.x();
    const double inset = random.uniform(0.4, 0.65);
    const Eigen::Vector2d spot =
        along_x ? Eigen::Vector2d(std::clamp(place, 0.7, size.x() - 0.7) - 0.5 * size.x(), inset - 0.5 * size.y())
                : Eigen::Vector2d(0.5 * size.x() - inset,
                                  std::clamp(place - size.x(), 0.7, size.y() - 0.7) - 0.5 * size.y());
    const SE3 pose = upright(side ? -spot.x() : spot.x(), side ? -spot.y() : spot.y(), 0.0,
                             (along_x ? 0.0 : M_PI / 2.0) + random.uniform(-0.25, 0.25));
    if (random.chance(0.45)) {
      addTable(mesh, random, pose, {random.uniform(1.0, 1.6), random.uniform(0.6, 0.8), random.uniform(0.7, 0.8)});
    } else {
      addBox(mesh, pose, {random.uniform(0.5, 1.3), random.uniform(0.35, 0.6), random.uniform(0.8, 2.1)},
             random.uniform(0.3, 0.7));
    }
  }
}

}  // namespace pcl_floam::simulator
