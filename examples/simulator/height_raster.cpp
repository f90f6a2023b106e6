#include "height_raster.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

HeightRaster::HeightRaster(const std::vector<Eigen::Vector3d>& path, double reach, const CrossSection& section)
{
  Eigen::Vector2d low = path.front().head<2>();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector3d& place : path) {
    low = low.cwiseMin(place.head<2>());
    high = high.cwiseMax(place.head<2>());
  }
  const double margin = reach + 2.0 * step();
  origin_ = low - Eigen::Vector2d::Constant(margin);
  const Eigen::Vector2d cells = (high - low + Eigen::Vector2d::Constant(2.0 * margin)) / step();
  columns_ = static_cast<std::size_t>(cells.x()) + 1;
  rows_ = static_cast<std::size_t>(cells.y()) + 1;
  fill(path, reach);
  if (section) {
    addSection(path, section);
  }
}

void HeightRaster::addSection(const std::vector<Eigen::Vector3d>& path, const CrossSection& section)
{
  std::vector<double> along{0.0};
  for (std::size_t n = 1; n < path.size(); ++n) {
    along.push_back(along.back() + (path[n] - path[n - 1]).head<2>().norm());
  }
  for (std::size_t i = 0; i < columns_; ++i) {
    for (std::size_t k = 0; k < rows_; ++k) {
      if (!covered_[i * rows_ + k]) {
        continue;
      }
      const Eigen::Vector2d node = corner(i, k);
      const auto nearest = std::min_element(path.begin(), path.end(), [&node](const auto& a, const auto& b) {
        return (a.template head<2>() - node).squaredNorm() < (b.template head<2>() - node).squaredNorm();
      });
      const auto n = static_cast<std::size_t>(nearest - path.begin());
      const Eigen::Vector3d ahead = path[std::min(n + 1, path.size() - 1)] - path[n > 0 ? n - 1 : 0];
      const Eigen::Vector2d off = node - nearest->head<2>();
      const double left = std::copysign(off.norm(), ahead.x() * off.y() - ahead.y() * off.x());
      heights_[i * rows_ + k] += section(along[n], left);
    }
  }
}

void HeightRaster::fill(const std::vector<Eigen::Vector3d>& path, double reach)
{
  constexpr double kSpread = 10.0;  // m over which the ground goes from one part of the path to another
  heights_.resize(columns_ * rows_);
  covered_.resize(columns_ * rows_);
  for (std::size_t i = 0; i < columns_; ++i) {
    for (std::size_t k = 0; k < rows_; ++k) {
      const Eigen::Vector2d node = corner(i, k);
      double weights = 0.0;
      double sum = 0.0;
      double nearest = reach * reach;
      for (const Eigen::Vector3d& place : path) {
        const double squared = (place.head<2>() - node).squaredNorm();
        const double ratio = squared / (kSpread * kSpread);
        const double weight = 1.0 / (0.01 + ratio * ratio * ratio);
        weights += weight;
        sum += weight * place.z();
        nearest = std::min(nearest, squared);
      }
      heights_[i * rows_ + k] = sum / weights;
      covered_[i * rows_ + k] = nearest < reach * reach;
    }
  }
}

double HeightRaster::height(double x, double y) const
{
  const double u = std::clamp((x - origin_.x()) / step(), 0.0, static_cast<double>(columns_ - 1) - 1e-9);
  const double v = std::clamp((y - origin_.y()) / step(), 0.0, static_cast<double>(rows_ - 1) - 1e-9);
  const auto i = static_cast<std::size_t>(u);
  const auto k = static_cast<std::size_t>(v);
  const double a = u - static_cast<double>(i);
  const double b = v - static_cast<double>(k);
  const auto at = [this](std::size_t column, std::size_t row) { return heights_[column * rows_ + row]; };
  return (1.0 - a) * ((1.0 - b) * at(i, k) + b * at(i, k + 1)) + a * ((1.0 - b) * at(i + 1, k) + b * at(i + 1, k + 1));
}

}  // namespace pcl_floam::simulator
