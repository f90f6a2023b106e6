#include "common/covariance.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cstddef>

namespace pcl_floam {

namespace {

/// Of any size that is asked for here, so that there is one decomposition.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 12, 12>;

/// Column by column.
template <std::ptrdiff_t n>
void multiply(const double* a, const double* b, double* product)
{
  std::fill_n(product, n * n, 0.0);
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      const double factor = b[j * n + k];
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        product[j * n + i] += a[k * n + i] * factor;
      }
    }
  }
}

template <typename Matrix>
Matrix productOf(const Matrix& a, const Matrix& b)
{
  Matrix product;
  multiply<Matrix::RowsAtCompileTime>(a.data(), b.data(), product.data());
  return product;
}

template <typename Matrix>
Matrix propagatedBy(const Matrix& jacobian, const Matrix& covariance)
{
  return productOf(productOf(jacobian, covariance), Matrix(jacobian.transpose()));
}

Square inverse(const Square& positive)
{
  return positive.ldlt().solve(Square::Identity(positive.rows(), positive.cols()));
}

}  // namespace

Matrix6 propagated(const Matrix6& jacobian, const Matrix6& covariance)
{
  return propagatedBy(jacobian, covariance);
}

Matrix12 propagated(const Matrix12& jacobian, const Matrix12& covariance)
{
  return propagatedBy(jacobian, covariance);
}

Matrix6 product(const Matrix6& a, const Matrix6& b)
{
  return productOf(a, b);
}

Matrix12 product(const Matrix12& a, const Matrix12& b)
{
  return productOf(a, b);
}

Matrix6 inverseOf(const Matrix6& positive)
{
  return inverse(positive);
}

Matrix12 inverseOf(const Matrix12& positive)
{
  return inverse(positive);
}

double squaredDeviations(const Vector6& error, const Matrix6& covariance)
{
  const Square square = covariance;
  const Vector6 weighted = square.ldlt().solve(error);
  return error.dot(weighted);
}

Matrix12 inBlocks(const Matrix6& top_left, const Matrix6& top_right, const Matrix6& bottom_left,
                  const Matrix6& bottom_right)
{
  Matrix12 all;
  all << top_left, top_right, bottom_left, bottom_right;
  return all;
}

}  // namespace pcl_floam
