#include "registration/residual_rows.h"

#include "common/multi_version.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// Sums are kept apart by row modulo this number, whatever the processor's registers hold.
constexpr std::size_t kLanes = 4;

struct ThreeSums {
  double of[3];
};

/// Of a b w. \param n a multiple of the lanes
PCL_FLOAM_MULTI_VERSION
double weightedProduct(const double* a, const double* b, const double* w, std::size_t n)
{
  double s[kLanes] = {};
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      s[lane] += w[i + lane] * (a[i + lane] * b[i + lane]);
    }
  }
  return (s[0] + s[1]) + (s[2] + s[3]);
}

/// Of a b w for each of three weights. \param n a multiple of the lanes
PCL_FLOAM_MULTI_VERSION
ThreeSums weightedProducts(const double* a, const double* b, const double* w0, const double* w1, const double* w2,
                           std::size_t n)
{
  double s0[kLanes] = {};
  double s1[kLanes] = {};
  double s2[kLanes] = {};
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double product = a[i + lane] * b[i + lane];
      s0[lane] += w0[i + lane] * product;
      s1[lane] += w1[i + lane] * product;
      s2[lane] += w2[i + lane] * product;
    }
  }
  return {{(s0[0] + s0[1]) + (s0[2] + s0[3]), (s1[0] + s1[1]) + (s1[2] + s1[3]), (s2[0] + s2[1]) + (s2[2] + s2[3])}};
}

}  // namespace

void ResidualRows::add(const Eigen::Vector3d& normal, const Eigen::Vector3d& arm, double residual, double weight,
                       double since_middle)
{
  const Eigen::Vector3d turn = arm.cross(normal);
  for (std::size_t i = 0; i < 3; ++i) {
    jacobian_[i][size_] = normal[static_cast<Eigen::Index>(i)];
    jacobian_[i + 3][size_] = turn[static_cast<Eigen::Index>(i)];
  }
  residual_[size_] = residual;
  weight_[0][size_] = weight;
  weight_[1][size_] = since_middle * weight;
  weight_[2][size_] = since_middle * since_middle * weight;
  is_timed_ = is_timed_ || since_middle != 0.0;
  ++size_;
}

/// M = sum d u u^T (LDL^T).
void ResidualRows::add(const Eigen::Matrix3d& m, const Eigen::Vector3d& difference, const Eigen::Vector3d& arm,
                       double weight)
{
  Eigen::Matrix3d rest = m;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double d = rest(i, i);
    if (d > 0.0) {
      const Eigen::Vector3d u = rest.col(i) / d;
      rest -= d * u * u.transpose();
      add(u, arm, u.dot(difference), d * weight, 0.0);
    }
  }
}

void ResidualRows::addTo(NormalEquations& equations)
{
  while (size_ % kLanes != 0) {
    add(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0, 0.0, 0.0);
  }
  const auto sumsOf = [this](const Column& a, const Column& b) {
    const double* w = weight_[0].data();
    return is_timed_ ? weightedProducts(a.data(), b.data(), w, weight_[1].data(), weight_[2].data(), size_)
                     : ThreeSums{{weightedProduct(a.data(), b.data(), w, size_), 0.0, 0.0}};
  };
  for (std::size_t i = 0; i < 6; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = i; j < 6; ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      const ThreeSums sums = sumsOf(jacobian_[i], jacobian_[j]);
      equations.information(row, column) += sums.of[0];
      equations.coupling(row, column) += sums.of[1];
      equations.twist_information(row, column) += sums.of[2];
      if (i != j) {
        equations.information(column, row) += sums.of[0];
        equations.coupling(column, row) += sums.of[1];
        equations.twist_information(column, row) += sums.of[2];
      }
    }
    const ThreeSums sums = sumsOf(jacobian_[i], residual_);
    equations.gradient[row] += sums.of[0];
    equations.twist_gradient[row] += sums.of[1];
  }
}

}  // namespace pcl_floam
