#include "registration/net_information.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

using Square6 = Eigen::Matrix<double, 6, 6>;
using Motions = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// What residuals tell that tell of one direction alone, as a part of them: less is nothing.
constexpr double kNothing = 1e-6;

/// Nothing, along each direction: it makes an information matrix positive.
Square6 nothingOf(const NormalEquations& e)
{
  return Square6((kNothing * e.weight * commonUnits(e).cwiseAbs2().cwiseInverse()).asDiagonal());
}

/// As motions k d see them that are looked for in place of d.
NormalEquations partOf(const NormalEquations& equations, const Square6& k)
{
  NormalEquations part = equations;
  for (Matrix6* m : {&part.information, &part.coupling, &part.twist_information}) {
    *m = k.transpose() * Square6(*m) * k;
  }
  for (Vector6* v : {&part.gradient, &part.twist_gradient}) {
    *v = k.transpose() * Eigen::Matrix<double, 6, 1>(*v);
  }
  return part;
}

}  // namespace

Vector6 commonUnits(const NormalEquations& equations)
{
  const double per_metre = std::sqrt(equations.weight / equations.squared_extent);
  Vector6 scale;
  scale << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
  return scale;
}

NetEquations& NetEquations::operator+=(const NetEquations& other)
{
  steps += other.steps;
  known += other.known;
  return *this;
}

NetEquations withoutNoise(const NormalEquations& equations)
{
  constexpr double kMayBe = 1.5;  // times what noise makes in the mean: it is now more, now less
  if (!(equations.squared_extent > 0.0)) {
    return {equations, equations};
  }
  const Square6 nothing = nothingOf(equations);
  const Square6 information = equations.information + nothing;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Square6> axes(Square6(equations.noise_information + nothing),
                                                               information);
  const Eigen::Matrix<double, 6, 1> root = (1.0 - kMayBe * axes.eigenvalues().array()).max(0.0).sqrt();
  const Square6 k = axes.eigenvectors() * root.asDiagonal() * axes.eigenvectors().transpose() * information;
  NetEquations net = {partOf(equations, k), {}};
  net.known = partOf(net.steps, k);
  net.steps.gradient = net.known.gradient;
  net.steps.twist_gradient = net.known.twist_gradient;
  return net;
}

UntoldMotions untoldMotions(const NormalEquations& net, const NormalEquations& all, const Matrix6& besides)
{
  // Axes have noise themselves: along one that is slightly off, others would seem to tell of it.
  constexpr double kNextToNothing = 0.03;
  UntoldMotions untold;
  if (!(all.squared_extent > 0.0)) {
    return untold;
  }
  const Vector6 units = commonUnits(all);
  const Square6 information = all.information + nothingOf(all);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Square6> axes(Square6(net.information), information);
  const Eigen::Index count = (axes.eigenvalues().array() < kNextToNothing).count();  // they are rising
  if (count == 0) {
    return untold;
  }
  const Motions scaled = units.cwiseInverse().asDiagonal() * axes.eigenvectors().leftCols(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Matrix<double, 6, 1> axis = axes.eigenvectors().col(i);  // so long that all tell a unit of it
    if (axis.dot(Square6(besides) * axis) < kNextToNothing) {
      const double eigenvalue = std::max(0.0, axes.eigenvalues()[i]) / (scaled.col(i).squaredNorm() * all.weight);
      untold.directions.push_back({scaled.col(i).normalized(), eigenvalue});
    }
  }
  const Motions q = Eigen::HouseholderQR<Motions>(scaled).householderQ() * Motions::Identity(6, count);
  untold.onto = units.asDiagonal() * Square6(q * q.transpose()) * units.cwiseInverse().asDiagonal();
  return untold;
}

}  // namespace pcl_floam
