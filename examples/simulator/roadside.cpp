#include "roadside.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

namespace {

/// What the facade of one house has in common.
struct FacadeStyle {
  int bays, storeys;
  double bay, storey;       ///< m
  double recess, pilaster;  ///< m
  double wall_reflectivity;
};

FacadeStyle chooseStyle(Random& random, double width)
{
  FacadeStyle style{};
  style.bays = std::max(1, static_cast<int>(width / random.uniform(2.4, 3.6)));
  style.bay = width / style.bays;
  style.storeys = 2 + random.index(4);
  style.storey = random.uniform(2.8, 3.4);
  style.recess = random.uniform(0.1, 0.3);
  style.pilaster = random.chance(0.4) ? random.uniform(0.08, 0.2) : 0.0;
  style.wall_reflectivity = random.uniform(0.25, 0.7);
  return style;
}

Relief facade(Random& random, const FacadeStyle& style)
{
  const double half_window = random.uniform(0.18, 0.34);  // of a bay
  std::vector<double> columns{0.0};
  for (int bay = 0; bay < style.bays; ++bay) {
    for (const double part : {0.08, 0.5 - half_window, 0.5 + half_window, 0.92, 1.0}) {
      columns.push_back((bay + part) * style.bay);
    }
  }
  std::vector<double> rows{-2.0, 0.6};
  for (int storey = 0; storey < style.storeys; ++storey) {
    const double floor = 0.2 + storey * style.storey;
    rows.insert(rows.end(), {floor + 0.9, floor + 2.3});
  }
  const double top = 0.4 + style.storeys * style.storey;
  rows.insert(rows.end(), {top, top + 0.35});
  Relief relief(columns, rows, {0.0, style.wall_reflectivity});
  const std::size_t height = rows.size() - 1;
  for (std::size_t c = 0; c + 1 < columns.size(); ++c) {
    for (std::size_t r = 0; r < height; ++r) {
      const bool window = c % 5 == 2 && r % 2 == 0 && r > 0 && r + 1 < height;
      const bool pilaster = c % 5 == 0 || c % 5 == 4;
      if (window) {
        relief.cell(r, c) = {-style.recess, 0.25, kGlassGloss};
      } else if (pilaster) {
        relief.cell(r, c).depth = style.pilaster;
      }
    }
    relief.cell(0, c).depth = 0.06;
    relief.cell(height - 1, c).depth = 0.3;
  }
  const auto door = static_cast<std::size_t>(5 * random.index(style.bays) + 2);
  for (std::size_t r = 0; r < 3; ++r) {
    relief.cell(r, door) = {-1.5 * style.recess, 0.35};
  }
  return relief;
}

void addBalconies(TriangleMesh& mesh, Random& random, const SE3& world_T_front, const FacadeStyle& style)
{
  for (int storey = 1; storey < style.storeys; ++storey) {
    for (int bay = 0; bay < style.bays; ++bay) {
      if (random.chance(0.35)) {
        const SE3 place = upright((bay + 0.5) * style.bay, 0.5, 0.2 + storey * style.storey);
        addBox(mesh, world_T_front * place, {0.75 * style.bay, 1.0, 0.15}, style.wall_reflectivity);
        addBox(mesh, world_T_front * place * upright(0.0, 0.48, 0.15), {0.75 * style.bay, 0.04, 0.85}, 0.4);
      }
    }
  }
}

}  // namespace

void addStrip(TriangleMesh& mesh, Random& random, const PathLine& line, const Terrain& terrain,
              const StripExtent& extent, const std::vector<StripCorner>& section, double unevenness,
              double reflectivity)
{
  std::vector<Eigen::Vector3d> previous;
  for (double station = extent.from; station <= extent.to; station += extent.step) {
    std::vector<Eigen::Vector3d> cut;
    for (const StripCorner& corner : section) {
      const Eigen::Vector2d place = line.at(station, corner.left);
      const double uneven = unevenness > 0.0 ? unevenness * random.normal() : 0.0;
      cut.emplace_back(place.x(), place.y(), terrain.height(place.x(), place.y()) + corner.height + uneven);
    }
    for (std::size_t i = 1; i < cut.size() && !previous.empty(); ++i) {
      addQuad(mesh, {previous[i - 1], previous[i], cut[i], cut[i - 1]}, reflectivity);
    }
    previous = std::move(cut);
  }
}

void addHouse(TriangleMesh& mesh, Random& random, const SE3& world_T_front, double width)
{
  const FacadeStyle style = chooseStyle(random, width);
  addRelief(mesh, world_T_front, facade(random, style));
  if (random.chance(0.35)) {
    addBalconies(mesh, random, world_T_front, style);
  }
  constexpr double kDepth = 10.0;  // m
  const double height = 2.6 + style.storeys * style.storey;
  const SE3 behind = upright(0.5 * width, -0.5 * kDepth - 1.5 * style.recess - 0.01, -2.0);
  addBox(mesh, world_T_front * behind, {width, kDepth, height}, style.wall_reflectivity);
}

}  // namespace pcl_floam::simulator
