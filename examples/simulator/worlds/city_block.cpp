#include "city_block.h"

#include "../objects.h"
#include "../path_line.h"
#include "../roadside.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

constexpr double kKerb = 5.5;    // m from the middle of the street to its kerb
constexpr double kFacade = 9.0;  // m from the middle of the street to the houses

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// A pose on the ground beside a line that has the block on its left.
SE3 beside(const PathLine& edge, const Terrain& terrain, double station, double left, double yaw, double lift = 0.0)
{
  const Eigen::Vector2d place = edge.at(station, left);
  return upright(place.x(), place.y(), terrain.height(place.x(), place.y()) + lift, edge.heading(station) + yaw);
}

/// Houses shoulder to shoulder, with a gap and trees here and there.
void addHouses(TriangleMesh& mesh, Random& random, const Terrain& terrain, const PathLine& front)
{
  double station = random.uniform(0.0, 1.0);
  while (station < front.length() - 7.0) {
    const double width = std::min(random.uniform(8.0, 20.0), front.length() - station);
    const double setback = random.chance(0.2) ? random.uniform(2.0, 4.0) : random.uniform(0.0, 0.6);
    if (random.chance(0.12)) {
      addTree(mesh, random, beside(front, terrain, station + 0.5 * width, 4.0, 0.0));
      addStrip(mesh, random, front, terrain, {station, station + width, 2.0}, {{0.3, 0.0}, {0.3, 1.1}}, 0.0, 0.4);
    } else {
      // The block is to the left of the edge, so a facade that looks right starts at the far end and turns back.
      addHouse(mesh, random, beside(front, terrain, station + width, setback, M_PI), width);
    }
    station += width + (random.chance(0.2) ? random.uniform(1.0, 4.0) : 0.0);
  }
}

/// What stands on the pavement's edge, and the cars parked before it.
void addStreetFurniture(TriangleMesh& mesh, Random& random, const Terrain& terrain, const PathLine& kerb)
{
  constexpr double kClear = 9.0;  // m kept free at the crossings
  for (double s = kClear + random.uniform(0.0, 8.0); s < kerb.length() - kClear; s += random.uniform(9.0, 15.0)) {
    if (random.chance(0.6)) {
      addTree(mesh, random, beside(kerb, terrain, s, 0.9, 0.0));
    }
  }
  for (double s = 4.0; s < kerb.length(); s += random.uniform(26.0, 34.0)) {
    addLamp(mesh, beside(kerb, terrain, s, 0.5, -M_PI / 2.0), random.uniform(5.0, 7.0));
  }
  for (double s = 3.0; s < kerb.length(); s += random.uniform(25.0, 60.0)) {
    addSign(mesh, random, beside(kerb, terrain, s, 0.45, M_PI));
  }
  for (double s = kClear; s < kerb.length() - kClear; s += random.uniform(5.2, 6.2)) {
    if (random.chance(0.55)) {
      const double yaw = (random.chance(0.9) ? 0.0 : M_PI) + random.uniform(-0.04, 0.04);
      addCar(mesh, random, beside(kerb, terrain, s, -1.15 + random.uniform(-0.1, 0.1), yaw));
    }
  }
}

}  // namespace

BlockOutline inset(const BlockOutline& outline, double distance)
{
  BlockOutline result;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d& corner = outline[i];
    const Eigen::Vector2d before = (corner - outline[(i + 3) % 4]).normalized();
    const Eigen::Vector2d after = (outline[(i + 1) % 4] - corner).normalized();
    // Where the two edges, each moved to its left, meet.
    result[i] = corner + (after - before) * (distance / turn(before, after));
  }
  return result;
}

void addCityBlock(TriangleMesh& mesh, Random& random, const Terrain& terrain, const BlockOutline& crossings)
{
  const BlockOutline kerb_corners = inset(crossings, kKerb);
  const BlockOutline front_corners = inset(crossings, kFacade);
  for (std::size_t i = 0; i < 4; ++i) {
    const PathLine kerb({kerb_corners[i], kerb_corners[(i + 1) % 4]}, 0.0);
    const PathLine front({front_corners[i], front_corners[(i + 1) % 4]}, 0.0);
    addStrip(mesh, random, kerb, terrain, {0.0, kerb.length(), 2.0}, {{0.0, -0.1}, {0.0, 0.12}, {4.2, 0.12}}, 0.0, 0.3);
    addHouses(mesh, random, terrain, front);
    addStreetFurniture(mesh, random, terrain, kerb);
  }
}

}  // namespace pcl_floam::simulator
