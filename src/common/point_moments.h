/// \file point_moments.h
/// Mean and covariance of a few points, and the axes along which they spread.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace pcl_floam {

/// How far points spread along each of three axes at right angles.
struct PrincipalAxes {
  Eigen::Vector3d variance;   ///< m^2, rising
  Eigen::Matrix3d direction;  ///< columns, unit
};

/// Running sums over points: half of a symmetric matrix is enough.
class PointMoments {
public:
  void add(const Eigen::Vector3d& p)
  {
    x_ += p.x();
    y_ += p.y();
    z_ += p.z();
    xx_ += p.x() * p.x();
    xy_ += p.x() * p.y();
    xz_ += p.x() * p.z();
    yy_ += p.y() * p.y();
    yz_ += p.y() * p.z();
    zz_ += p.z() * p.z();
    ++count_;
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] Eigen::Vector3d mean() const { return sum() / static_cast<double>(count_); }

  /// Sums of the coordinates' products.
  [[nodiscard]] Eigen::Matrix3d squares() const
  {
    Eigen::Matrix3d squares;
    squares << xx_, xy_, xz_, xy_, yy_, yz_, xz_, yz_, zz_;
    return squares;
  }

  [[nodiscard]] PrincipalAxes axes() const
  {
    const double count = count_;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(squares() / count - sum() * sum().transpose() / (count * count));
    return {solver.eigenvalues(), solver.eigenvectors()};
  }

private:
  [[nodiscard]] Eigen::Vector3d sum() const { return {x_, y_, z_}; }

  double x_ = 0.0, y_ = 0.0, z_ = 0.0;
  double xx_ = 0.0, xy_ = 0.0, xz_ = 0.0, yy_ = 0.0, yz_ = 0.0, zz_ = 0.0;
  int count_ = 0;
};

}  // namespace pcl_floam
