#include "triangle_mesh.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace pcl_floam::simulator {

namespace {

std::uint32_t addVertex(TriangleMesh& mesh, const Eigen::Vector3d& p)
{
  mesh.vertices.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void addTriangle(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, double reflectivity)
{
  mesh.triangles.push_back({a, b, c});
  mesh.reflectivity.push_back(static_cast<float>(reflectivity));
}

Eigen::Vector3d randomDirection(Random& random)
{
  const double z = random.uniform(-1.0, 1.0);
  const double angle = random.uniform(0.0, 2.0 * M_PI);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace

SE3 upright(double x, double y, double z, double yaw)
{
  return {Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(), Eigen::Vector3d(x, y, z)};
}

void addQuad(TriangleMesh& mesh, const std::array<Eigen::Vector3d, 4>& corners, double reflectivity)
{
  const std::uint32_t a = addVertex(mesh, corners[0]);
  const std::uint32_t b = addVertex(mesh, corners[1]);
  const std::uint32_t c = addVertex(mesh, corners[2]);
  const std::uint32_t d = addVertex(mesh, corners[3]);
  addTriangle(mesh, a, b, c, reflectivity);
  addTriangle(mesh, a, c, d, reflectivity);
}

void addBox(TriangleMesh& mesh, const SE3& world_T_box, const Eigen::Vector3d& size, double reflectivity, double taper)
{
  std::array<Eigen::Vector3d, 8> corner;
  for (std::size_t i = 0; i < 8; ++i) {
    const bool top = (i & 4U) != 0;
    const double scale = 0.5 * (top ? taper : 1.0);
    const double x = ((i & 1U) != 0 ? scale : -scale) * size.x();
    const double y = ((i & 2U) != 0 ? scale : -scale) * size.y();
    corner[i] = world_T_box * Eigen::Vector3d(x, y, top ? size.z() : 0.0);
  }
  constexpr std::array<std::array<std::size_t, 4>, 6> kFaces{
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  for (const auto& face : kFaces) {
    addQuad(mesh, {corner[face[0]], corner[face[1]], corner[face[2]], corner[face[3]]}, reflectivity);
  }
}

void addCylinder(TriangleMesh& mesh, const SE3& world_T_cylinder, double radius, double height, double reflectivity,
                 double taper, int sides)
{
  for (int i = 0; i < sides; ++i) {
    const double from = 2.0 * M_PI * i / sides;
    const double to = 2.0 * M_PI * (i + 1) / sides;
    const Eigen::Vector3d a(radius * std::cos(from), radius * std::sin(from), 0.0);
    const Eigen::Vector3d b(radius * std::cos(to), radius * std::sin(to), 0.0);
    const Eigen::Vector3d up(0.0, 0.0, height);
    addQuad(mesh,
            {world_T_cylinder * a, world_T_cylinder * b, world_T_cylinder * (taper * b + up),
             world_T_cylinder * (taper * a + up)},
            reflectivity);
  }
}

void addFoliage(TriangleMesh& mesh, Random& random, const SE3& world_T_crown, const Eigen::Vector3d& radii, double leaf,
                int count, double reflectivity)
{
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d direction = randomDirection(random);
    const Eigen::Vector3d centre = (std::cbrt(random.uniform(0.1, 1.0)) * direction).cwiseProduct(radii);
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) {
      const Eigen::Vector3d offset = randomDirection(random);
      corner = addVertex(mesh, world_T_crown * (centre + leaf * offset));
    }
    addTriangle(mesh, corners[0], corners[1], corners[2], reflectivity);
  }
}

void polish(TriangleMesh& mesh, std::size_t first, double gloss)
{
  mesh.gloss.resize(first, 0.0F);
  mesh.gloss.resize(mesh.triangles.size(), static_cast<float>(gloss));
}

void addGround(TriangleMesh& mesh, const Terrain& terrain, const GroundPatch& patch,
               const std::function<double(double x, double y)>& reflectivity)
{
  const auto columns = static_cast<std::uint32_t>(std::ceil((patch.max_x - patch.min_x) / patch.step)) + 1;
  const auto rows = static_cast<std::uint32_t>(std::ceil((patch.max_y - patch.min_y) / patch.step)) + 1;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const double x = patch.min_x + column * patch.step;
      const double y = patch.min_y + row * patch.step;
      addVertex(mesh, {x, y, terrain.height(x, y)});
      if (row + 1 < rows && column + 1 < columns) {
        const std::uint32_t corner = first + row * columns + column;
        const double brightness = reflectivity(x, y);
        addTriangle(mesh, corner, corner + 1, corner + columns + 1, brightness);
        addTriangle(mesh, corner, corner + columns + 1, corner + columns, brightness);
      }
    }
  }
}

Relief::Relief(std::vector<double> column_borders, std::vector<double> row_borders, const ReliefCell& cell)
    : columns(std::move(column_borders)),
      rows(std::move(row_borders)),
      cells((columns.size() - 1) * (rows.size() - 1), cell)
{
}

void addRelief(TriangleMesh& mesh, const SE3& world_T_wall, const Relief& relief)
{
  const auto point = [&](std::size_t column, double depth, std::size_t row) {
    return world_T_wall * Eigen::Vector3d(relief.columns[column], depth, relief.rows[row]);
  };
  const std::size_t width = relief.columns.size() - 1;
  const std::size_t height = relief.rows.size() - 1;
  for (std::size_t r = 0; r < height; ++r) {
    for (std::size_t c = 0; c < width; ++c) {
      const auto [depth, reflectivity, gloss] = relief.cell(r, c);
      const std::size_t face = mesh.triangles.size();
      addQuad(mesh, {point(c, depth, r), point(c + 1, depth, r), point(c + 1, depth, r + 1), point(c, depth, r + 1)},
              reflectivity);
      if (gloss > 0.0) {
        polish(mesh, face, gloss);
      }
      const double right = c + 1 < width ? relief.cell(r, c + 1).depth : depth;
      if (right != depth) {
        addQuad(
            mesh,
            {point(c + 1, depth, r), point(c + 1, right, r), point(c + 1, right, r + 1), point(c + 1, depth, r + 1)},
            reflectivity);
      }
      const double above = r + 1 < height ? relief.cell(r + 1, c).depth : depth;
      if (above != depth) {
        addQuad(
            mesh,
            {point(c, depth, r + 1), point(c, above, r + 1), point(c + 1, above, r + 1), point(c + 1, depth, r + 1)},
            reflectivity);
      }
    }
  }
}

}  // namespace pcl_floam::simulator
