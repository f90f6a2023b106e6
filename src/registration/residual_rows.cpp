#include "registration/residual_rows.h"

#include "common/multi_version.h"

#include <algorithm>
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

/// Of a b w and a c w for each of some weights. \param n a multiple of the lanes
template <std::size_t weights>
__attribute__((always_inline)) inline void addProducts(const double* a, const double* b, const double* c,
                                                       const std::array<const double*, 3>& w, std::size_t n,
                                                       ThreeSums& with_b, ThreeSums& with_c)
{
  Lanes sums_b[weights] = {};
  Lanes sums_c[weights] = {};
  for (std::size_t i = 0; i < n; i += kLanes) {
    Lanes left;
    Lanes right_b;
    Lanes right_c;
    load(a + i, left);
    load(b + i, right_b);
    load(c + i, right_c);
    right_b *= left;
    right_c *= left;
    for (std::size_t k = 0; k < weights; ++k) {
      Lanes weight;
      load(w[k] + i, weight);
      sums_b[k] += weight * right_b;
      sums_c[k] += weight * right_c;
    }
  }
  for (std::size_t k = 0; k < weights; ++k) {
    addUp(sums_b[k], with_b.of[k]);
    addUp(sums_c[k], with_c.of[k]);
  }
}

PCL_FLOAM_MULTI_VERSION
void addTimedProducts(const double* a, const double* b, const double* c, const std::array<const double*, 3>& w,
                      std::size_t n, ThreeSums& with_b, ThreeSums& with_c)
{
  addProducts<3>(a, b, c, w, n, with_b, with_c);
}

/// Where all times are that of the pose, their weights are zero.
PCL_FLOAM_MULTI_VERSION
void addUntimedProducts(const double* a, const double* b, const double* c, const std::array<const double*, 3>& w,
                        std::size_t n, ThreeSums& with_b, ThreeSums& with_c)
{
  addProducts<1>(a, b, c, w, n, with_b, with_c);
}

}  // namespace

void ResidualRows::add(const Vector6& derivative, double residual, double weight, double since_middle)
{
  for (std::size_t i = 0; i < kResidual; ++i) {
    column_[i][size_] = derivative[static_cast<Eigen::Index>(i)];
  }
  column_[kResidual][size_] = residual;
  weight_[0][size_] = weight;
  weight_[1][size_] = since_middle * weight;
  weight_[2][size_] = since_middle * since_middle * weight;
  is_timed_ = is_timed_ || since_middle != 0.0;
  has_residuals_ = has_residuals_ || residual != 0.0;
  ++size_;
}

void ResidualRows::add(const Eigen::Vector3d& normal, const Eigen::Vector3d& arm, double residual, double weight,
                       double since_middle)
{
  Vector6 derivative;
  derivative << normal, arm.cross(normal);
  add(derivative, residual, weight, since_middle);
}

/// M = sum d u u^T (LDL^T).
void ResidualRows::add(const Eigen::Matrix3d& m, const Eigen::Vector3d& difference, const Eigen::Vector3d& arm,
                       double weight, double since_middle)
{
  constexpr double kUnseen = 1e-6;  // of a residual
  Eigen::Matrix3d rest = m;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double d = rest(i, i);
    if (d > kUnseen) {
      const Eigen::Vector3d u = rest.col(i) / d;
      rest -= d * u * u.transpose();
      add(u, arm, u.dot(difference), d * weight, since_middle);
    }
  }
}

void ResidualRows::addTo(NormalEquations& equations)
{
  while (size_ % kLanes != 0) {
    add(Vector6::Zero(), 0.0, 0.0, 0.0);
  }
  const std::array<const double*, 3> weights = {weight_[0].data(), weight_[1].data(), weight_[2].data()};
  std::array<ThreeSums, kColumns + 1> sums{};
  const std::size_t columns = has_residuals_ ? kColumns : kResidual;
  const auto addAll = is_timed_ ? addTimedProducts : addUntimedProducts;
  for (std::size_t i = 0; i < kResidual; ++i) {
    for (std::size_t j = i; j < columns; j += 2) {
      const double* next = column_[std::min(j + 1, kResidual)].data();
      addAll(column_[i].data(), column_[j].data(), next, weights, size_, sums[j], sums[j + 1]);
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
