#include "registration/line_plane_fit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pcl_floam {

namespace {

/// Mean and covariance of a few points.
struct Moments {
  explicit Moments(const Neighbors& neighbors)
  {
    for (int i = 0; i < neighbors.count; ++i) {
      const Eigen::Vector3d point = neighbors[i].offset.cast<double>();
      center += point;
      covariance += point * point.transpose();
    }
    const double count = neighbors.count;
    center /= count;
    covariance = covariance / count - center * center.transpose();
  }

  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// The sum of the second-order principal minors: the products of two eigenvalues each, added up.
double sumOfMinors(const Eigen::Matrix3d& m)
{
  return m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1) + m(0, 0) * m(2, 2) - m(0, 2) * m(0, 2) + m(1, 1) * m(2, 2) -
         m(1, 2) * m(1, 2);
}

/// The smallest eigenvalue of a covariance: Newton's steps from 0, where the characteristic polynomial is convex and
/// falls, come near it from below; two or three do for points on a plane. With it and the trace, the other two follow
/// from a square root: no trigonometry.
double smallestEigenvalue(const Eigen::Matrix3d& covariance, double minors)
{
  constexpr int kMostSteps = 30;
  constexpr double kNegligiblePart = 1e-9;  // of the trace
  const double trace = covariance.trace();
  const double determinant = covariance.determinant();
  double value = 0.0;
  for (int i = 0; i < kMostSteps; ++i) {
    const double polynomial = determinant - value * (minors - value * (trace - value));
    const double slope = minors - value * (2.0 * trace - 3.0 * value);
    if (!(slope > 0.0) || !(polynomial > 0.0)) {
      break;
    }
    const double step = polynomial / slope;
    value += step;
    if (step < kNegligiblePart * trace) {
      break;
    }
  }
  return value;
}

/// The unit vector that \p m, of rank two, takes to zero: the longest column of its adjugate.
Eigen::Vector3d nullDirection(const Eigen::Matrix3d& m)
{
  const Eigen::Vector3d diagonal(m(1, 1) * m(2, 2) - m(1, 2) * m(1, 2), m(0, 0) * m(2, 2) - m(0, 2) * m(0, 2),
                                 m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1));
  const double xy = m(0, 2) * m(1, 2) - m(0, 1) * m(2, 2);
  const double xz = m(0, 1) * m(1, 2) - m(0, 2) * m(1, 1);
  const double yz = m(0, 1) * m(0, 2) - m(0, 0) * m(1, 2);
  int longest = 0;
  diagonal.maxCoeff(&longest);
  const std::array<Eigen::Vector3d, 3> columns = {Eigen::Vector3d(diagonal.x(), xy, xz),
                                                  Eigen::Vector3d(xy, diagonal.y(), yz),
                                                  Eigen::Vector3d(xz, yz, diagonal.z())};
  return columns[static_cast<std::size_t>(longest)].normalized();
}

/// How the points spread within their plane, along two axes of it.
class InPlane {
public:
  InPlane(const Moments& points, const Eigen::Vector3d& normal) : u(normal.unitOrthogonal()), v(normal.cross(u))
  {
    const Eigen::Vector3d along_v = points.covariance * v;
    uu = u.dot(points.covariance * u);
    uv = u.dot(along_v);
    vv = v.dot(along_v);
    determinant = uu * vv - uv * uv;
  }

  [[nodiscard]] bool isLine() const { return !(determinant > 0.0); }

  /// By what the plane's variance is larger at the query, the origin, than at the points' centre.
  [[nodiscard]] double extrapolation(const Eigen::Vector3d& center) const { return 1.0 + squaredDistance(center); }

  /// Points that scatter by sigma across a plane, and along it with the covariance C, leave its normal off by
  /// sigma^2 C^-1 / k: here as the two columns of a root of that (Cholesky). The scatter about a plane fitted to the
  /// same k points is less than that about the true one by (k - 3) / k.
  [[nodiscard]] std::array<Eigen::Vector3d, 2> tilt(double across, int count) const
  {
    const double sigma = std::sqrt(across / (count - 3));
    const double root = std::sqrt(vv / determinant);
    return {Eigen::Vector3d(sigma * (root * u - (uv / (root * determinant)) * v)),
            Eigen::Vector3d((sigma / std::sqrt(vv)) * v)};
  }

private:
  /// In standard deviations of the points.
  [[nodiscard]] double squaredDistance(const Eigen::Vector3d& from_center) const
  {
    const double along_u = u.dot(from_center);
    const double along_v = v.dot(from_center);
    return (vv * along_u * along_u - 2.0 * uv * along_u * along_v + uu * along_v * along_v) / determinant;
  }

  Eigen::Vector3d u;
  Eigen::Vector3d v;
  double uu = 0.0;
  double uv = 0.0;
  double vv = 0.0;
  double determinant = 0.0;
};

}  // namespace

std::optional<LineFit> fitLine(const Neighbors& neighbors, const RegistrationParameters& parameters)
{
  const Moments points(neighbors);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(points.covariance);
  const Eigen::Vector3d& eigenvalues = solver.eigenvalues();
  if (!(eigenvalues[2] > parameters.line_ratio * eigenvalues[1]) || !(eigenvalues[2] > 0.0)) {
    return std::nullopt;
  }
  return LineFit{points.center, solver.eigenvectors().col(2)};
}

std::optional<PlaneFit> fitPlane(const Neighbors& neighbors, const RegistrationParameters& parameters)
{
  const Moments points(neighbors);
  const double minors = sumOfMinors(points.covariance);
  const double across = smallestEigenvalue(points.covariance, minors);
  const double sum = points.covariance.trace() - across;  // of the other two eigenvalues
  const double product = minors - across * sum;
  const double longest = 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * product)));
  const double shorter = sum - longest;
  if (!(shorter > parameters.plane_ratio * across) || !(shorter > parameters.plane_spread * longest)) {
    return std::nullopt;
  }
  const Eigen::Vector3d normal = nullDirection(points.covariance - across * Eigen::Matrix3d::Identity());
  const InPlane in_plane(points, normal);
  if (in_plane.isLine()) {  // up to rounding
    return std::nullopt;
  }
  return PlaneFit{points.center, normal, across * in_plane.extrapolation(points.center),
                  in_plane.tilt(across, neighbors.count)};
}

}  // namespace pcl_floam
