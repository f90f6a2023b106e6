/// \file residual_rows.h
/// Residuals side by side, so that their sums take straight lines through memory.
#pragma once

#include "registration/normal_equations.h"

#include <array>
#include <cstddef>

namespace pcl_floam {

/// Scalar residuals r = n^T (q - c), whose derivative by the pose is J = n^T [I, -[arm]x] (Eq. 11, 13, 14), and by the
/// velocity J times the point's time since mid-sweep.
class ResidualRows {
public:
  static constexpr std::size_t kRoom = 192;

  /// \param derivative J, by the pose
  void add(const Vector6& derivative, double residual, double weight, double since_middle);
  /// \param arm from the local origin to the point
  void add(const Eigen::Vector3d& normal, const Eigen::Vector3d& arm, double residual, double weight,
           double since_middle);

  /// The three residuals that a difference makes whose directions count differently: its square is d^T M d.
  /// \param m symmetric, positive semi-definite: how much a residual along each direction counts, about one at most
  void add(const Eigen::Matrix3d& m, const Eigen::Vector3d& difference, const Eigen::Vector3d& arm, double weight,
           double since_middle);

  /// H, b and what couples pose and velocity in them (Eq. 10), bit-identical for every processor.
  void addTo(NormalEquations& equations);

private:
  using Column = std::array<double, kRoom>;

  static constexpr std::size_t kResidual = 6;  ///< its column, after those of the derivative
  static constexpr std::size_t kColumns = 7;

  std::size_t size_ = 0;
  bool is_timed_ = false;       ///< else all were measured at the pose's instant
  bool has_residuals_ = false;  ///< else all are zero
  std::array<Column, kColumns> column_;
  std::array<Column, 3> weight_;  ///< times the time since mid-sweep to the power of 0, 1, 2
};

}  // namespace pcl_floam
