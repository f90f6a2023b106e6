/// \file height_raster.h
/// Ground that follows a path through space.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace pcl_floam::simulator {

/// Height of the ground above what is level across a path, m.
/// \param along m along the path
/// \param left  m to the left of it
using CrossSection = std::function<double(double along, double left)>;

/// Heights on a grid about a path: at the path its own, beside it those of the nearest parts of it, smoothly.
class HeightRaster {
public:
  /// \param path  m, places on the ground, a few metres apart
  /// \param reach m, to each side of the path that there is ground
  /// \param section ditches and banks beside the path; none if empty
  HeightRaster(const std::vector<Eigen::Vector3d>& path, double reach, const CrossSection& section = {});

  [[nodiscard]] double height(double x, double y) const;

  /// Whether the grid's cell (i, k) lies within reach of the path.
  [[nodiscard]] bool covers(std::size_t i, std::size_t k) const { return covered_[i * rows_ + k]; }

  /// The lower left corner of a cell, m.
  [[nodiscard]] Eigen::Vector2d corner(std::size_t i, std::size_t k) const
  {
    return origin_ + step() * Eigen::Vector2d(static_cast<double>(i), static_cast<double>(k));
  }

  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }

  /// m between the nodes
  [[nodiscard]] static double step() { return 3.0; }

private:
  void fill(const std::vector<Eigen::Vector3d>& path, double reach);
  void addSection(const std::vector<Eigen::Vector3d>& path, const CrossSection& section);

  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<double> heights_;
  std::vector<bool> covered_;
};

}  // namespace pcl_floam::simulator
