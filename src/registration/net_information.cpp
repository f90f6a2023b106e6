#include "registration/net_information.h"

#include "common/covariance.h"
#include "common/eigen_analysis.h"
#include "registration/information_analysis.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// What residuals tell that tell of one direction alone, as a part of them: less is nothing.
constexpr double kNothing = 1e-6;

/// Nothing, along each direction: it makes an information matrix positive.
Matrix6 nothingOf(const NormalEquations& e)
{
  return Matrix6((kNothing * e.weight * commonUnits(e).cwiseAbs2().cwiseInverse()).asDiagonal());
}

/// As motions k d see them that are looked for in place of d.
NormalEquations partOf(const NormalEquations& equations, const Matrix6& k)
{
  NormalEquations part = equations;
  for (Matrix6* m : {&part.information, &part.coupling, &part.twist_information}) {
    *m = propagated(k.transpose(), *m);
  }
  for (Vector6* v : {&part.gradient, &part.twist_gradient}) {
    *v = Vector6(k.transpose() * *v);
  }
  return part;
}

/// Of the motions that \p among spans, at right angles, those of which \p told is next to nothing of the information.
Motions scarcelyToldBy(const Matrix6& told, const Matrix6& information, const Motions& among)
{
  // Axes have noise themselves: along one that is slightly off, others would seem to tell of it.
  constexpr double kNextToNothing = 0.03;
  if (among.cols() == 0) {
    return among;
  }
  const EigenAnalysis axes = analyse(within(told, among), within(information, among));
  const Eigen::Index count = (axes.values.array() < kNextToNothing).count();  // they are rising
  return orthonormalBeside(Motions(6, 0), Motions(among * axes.vectors.leftCols(count)));
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
  const Matrix6 nothing = nothingOf(equations);
  const Matrix6 information = equations.information + nothing;
  const EigenAnalysis axes = analyse(equations.noise_information + nothing, information);
  const Vector6 root = (1.0 - kMayBe * axes.values.array()).max(0.0).sqrt().matrix();
  const Matrix6 k = product(propagated(axes.vectors, Matrix6(root.asDiagonal())), information);
  NetEquations net = {partOf(equations, k), {}};
  net.known = partOf(net.steps, k);
  net.steps.gradient = net.known.gradient;
  net.steps.twist_gradient = net.known.twist_gradient;
  return net;
}

UntoldMotions untoldMotions(const NormalEquations& net, const NormalEquations& all, const Matrix6& besides)
{
  UntoldMotions untold;
  if (!(all.squared_extent > 0.0)) {
    return untold;
  }
  const Vector6 units = commonUnits(all);
  const auto inUnits = [&](const Matrix6& m) { return propagated(Matrix6(units.asDiagonal()), m); };
  const Matrix6 information = inUnits(all.information + nothingOf(all));
  const Matrix6 told = inUnits(net.information);
  const Motions motions = scarcelyToldBy(told, information, Motions::Identity(6, 6));
  untold.onto = units.asDiagonal() * Matrix6(motions * motions.transpose()) * units.cwiseInverse().asDiagonal();
  const Motions named = scarcelyToldBy(inUnits(besides), information, motions);
  for (Eigen::Index i = 0; i < named.cols(); ++i) {
    const Vector6 direction = named.col(i);
    untold.directions.push_back({direction, std::max(0.0, direction.dot(told * direction)) / all.weight});
  }
  return untold;
}

}  // namespace pcl_floam
