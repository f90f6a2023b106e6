#include "registration/residual_rows.h"

#include "common/multi_version.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace pcl_floam {

namespace {

/// Sums are kept apart by row modulo this number, whatever the processor's registers hold.
constexpr std::size_t kLanes = 4;

/// As many numbers, told to the compiler: it would shuffle loops over them.
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

inline void load(const double* from, Lanes& to)
{
  std::memcpy(&to, from, sizeof(to));
}

inline void addUp(const Lanes& lanes, double& sum)
{
  sum = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/// For each of three weights.
struct ThreeSums {
  double of[3];
};

/// Of a b w and a c w for a weight. \param n a multiple of the lanes
PCL_FLOAM_MULTI_VERSION
void weightedProducts(const double* a, const double* b, const double* c, const double* w, std::size_t n, double& with_b,
                      double& with_c)
{
  Lanes sum_b = {};
  Lanes sum_c = {};
  for (std::size_t i = 0; i < n; i += kLanes) {
    Lanes left;
    Lanes weight;
    Lanes right_b;
    Lanes right_c;
    load(a + i, left);
    load(w + i, weight);
    load(b + i, right_b);
    load(c + i, right_c);
    right_b *= left;
    right_c *= left;
    sum_b += weight * right_b;
    sum_c += weight * right_c;
  }
  addUp(sum_b, with_b);
  addUp(sum_c, with_c);
}

/// Of a b w and a c w for each of three weights. \param n a multiple of the lanes
PCL_FLOAM_MULTI_VERSION
void weightedProducts(const double* a, const double* b, const double* c, const std::array<const double*, 3>& w,
                      std::size_t n, ThreeSums& with_b, ThreeSums& with_c)
{
  Lanes sums_b[3] = {};
  Lanes sums_c[3] = {};
  for (std::size_t i = 0; i < n; i += kLanes) {
    Lanes left;
    Lanes right_b;
    Lanes right_c;
    load(a + i, left);
    load(b + i, right_b);
    load(c + i, right_c);
    right_b *= left;
    right_c *= left;
    for (std::size_t k = 0; k < 3; ++k) {
      Lanes weight;
      load(w[k] + i, weight);
      sums_b[k] += weight * right_b;
      sums_c[k] += weight * right_c;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    addUp(sums_b[k], with_b.of[k]);
    addUp(sums_c[k], with_c.of[k]);
  }
}

}  // namespace

void ResidualRows::add(const Eigen::Vector3d& normal, const Eigen::Vector3d& arm, double residual, double weight,
                       double since_middle)
{
  const Eigen::Vector3d turn = arm.cross(normal);
  for (std::size_t i = 0; i < 3; ++i) {
    column_[i][size_] = normal[static_cast<Eigen::Index>(i)];
    column_[i + 3][size_] = turn[static_cast<Eigen::Index>(i)];
  }
  column_[kResidual][size_] = residual;
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
  const std::array<const double*, 3> weights = {weight_[0].data(), weight_[1].data(), weight_[2].data()};
  std::array<ThreeSums, kColumns + 1> sums{};
  for (std::size_t i = 0; i < kResidual; ++i) {
    for (std::size_t j = i; j < kColumns; j += 2) {
      const double* next = column_[std::min(j + 1, kResidual)].data();
      if (is_timed_) {
        weightedProducts(column_[i].data(), column_[j].data(), next, weights, size_, sums[j], sums[j + 1]);
      } else {
        weightedProducts(column_[i].data(), column_[j].data(), next, weights[0], size_, sums[j].of[0],
                         sums[j + 1].of[0]);
      }
    }
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = i; j < kResidual; ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      equations.information(row, column) += sums[j].of[0];
      equations.coupling(row, column) += sums[j].of[1];
      equations.twist_information(row, column) += sums[j].of[2];
      if (i != j) {
        equations.information(column, row) += sums[j].of[0];
        equations.coupling(column, row) += sums[j].of[1];
        equations.twist_information(column, row) += sums[j].of[2];
      }
    }
    equations.gradient[row] += sums[kResidual].of[0];
    equations.twist_gradient[row] += sums[kResidual].of[1];
  }
}

}  // namespace pcl_floam
