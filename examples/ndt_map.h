// A map for example 07: cells of one size, as NDT has them, each with the plane of its points.
#pragma once

#include <pcl_floam/odometry/odometry.h>

#include <Eigen/Eigenvalues>

#include <array>
#include <bitset>
#include <cmath>
#include <map>
#include <memory>

struct NdtMap : pcl_floam::SurfaceMap {
  struct Cell {
    Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();  // sum of x x^T with x = (x, y, z, 1)
    std::bitset<128> lasers;  // that have seen it: what one draws by itself, on whatever it hits, is no plane
  };
  static constexpr double kSide = 2.5;  // m
  std::map<std::array<double, 3>, Cell> cells;

  static auto keyOf(const Eigen::Vector3d& p) { return std::array{floor(p.x()), floor(p.y()), floor(p.z())}; }
  static pcl_floam::Surface planeOf(const Cell& cell)
  {
    pcl_floam::Surface plane;
    plane.count = static_cast<std::uint32_t>(cell.moments(3, 3));
    plane.center = cell.moments.topRightCorner<3, 1>() / plane.count;
    const Eigen::Matrix3d squares = cell.moments.topLeftCorner<3, 3>() / plane.count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(squares - plane.center * plane.center.transpose());
    plane.direction = eigen.eigenvectors().col(0);
    plane.thickness = eigen.eigenvalues()[0];  // of the variances, which rise
    plane.extent = eigen.eigenvalues()[1];
    const bool is_plane = plane.count > 5 && cell.lasers.count() > 2 && plane.thickness < 0.5 * plane.extent;
    plane.kind = is_plane ? pcl_floam::SurfaceKind::plane : pcl_floam::SurfaceKind::unknown;
    return plane;
  }
  std::unique_ptr<SurfaceMap> makeEmpty(double /*side*/) const override { return std::make_unique<NdtMap>(); }
  std::unique_ptr<SurfaceMap> copy() const override { return std::make_unique<NdtMap>(*this); }
  bool empty() const override { return cells.empty(); }
  void clear() override { cells.clear(); }
  void insert(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count) override
  {
    for (std::size_t i = 0; i < count; ++i) {
      Cell& cell = cells[keyOf(places[i] / kSide)];
      const Eigen::Vector4d x = places[i].homogeneous();
      cell.moments += x * x.transpose();
      cell.lasers.set(lasers[i] % 128);
    }
  }
  void find(const Eigen::Vector3d* p, std::size_t n, pcl_floam::Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < n; ++i) {
      const auto cell = p[i].allFinite() ? cells.find(keyOf(p[i] / kSide)) : cells.end();
      surfaces[i] = cell == cells.end() ? pcl_floam::Surface() : planeOf(cell->second);
    }
  }
};
