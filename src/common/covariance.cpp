#include "common/covariance.h"

#include <Eigen/Cholesky>

namespace pcl_floam {

namespace {

/// Of any size that is asked for here, so that there is one decomposition.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 12, 12>;

/// Column by column.
template <typename Matrix>
Matrix productOf(const Matrix& a, const Matrix& b)
{
  Matrix product = Matrix::Zero();
  for (Eigen::Index j = 0; j < product.cols(); ++j) {
    for (Eigen::Index k = 0; k < product.rows(); ++k) {
      for (Eigen::Index i = 0; i < product.rows(); ++i) {
        product(i, j) += a(i, k) * b(k, j);
      }
    }
  }
  return product;
}

Square inverse(const Square& positive)
{
  return positive.ldlt().solve(Square::Identity(positive.rows(), positive.cols()));
}

}  // namespace

Matrix6 propagated(const Matrix6& jacobian, const Matrix6& covariance)
{
  return product(product(jacobian, covariance), Matrix6(jacobian.transpose()));
}

Matrix12 propagated(const Matrix12& jacobian, const Matrix12& covariance)
{
  return product(product(jacobian, covariance), Matrix12(jacobian.transpose()));
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
