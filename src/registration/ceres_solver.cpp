#include "registration/ceres_solver.h"

#include "common/eigen_analysis.h"
#include "common/perturbation.h"
#include "registration/locked_motions.h"

#include <ceres/ceres.h>

#include <memory>

namespace pcl_floam {

namespace {

/// rho of Geman and McClure, which Ceres lacks.
class GemanMcClureLoss : public ceres::LossFunction {
public:
  explicit GemanMcClureLoss(double scale) : scale2_(scale * scale) {}

  void Evaluate(double squared, double rho[3]) const override
  {
    const double denominator = 1.0 + squared / scale2_;
    rho[0] = squared / denominator;
    rho[1] = 1.0 / (denominator * denominator);
    rho[2] = -2.0 / (scale2_ * denominator * denominator * denominator);
  }

private:
  double scale2_;
};

std::unique_ptr<ceres::LossFunction> makeLoss(RobustKernel kernel, double scale)
{
  switch (kernel) {
    case RobustKernel::huber: return std::make_unique<ceres::HuberLoss>(scale);
    case RobustKernel::cauchy: return std::make_unique<ceres::CauchyLoss>(scale);
    case RobustKernel::geman_mcclure: return std::make_unique<GemanMcClureLoss>(scale);
    case RobustKernel::none: break;
  }
  return nullptr;
}

/// d exp(phi)/d phi on the left: exp(phi + d) = exp(J d) exp(phi) to first order.
Eigen::Matrix3d rotationJacobian(const Eigen::Vector3d& phi)
{
  // The series sum of [phi]x^n / (n + 1)!, exact to double precision for the small angles of one step.
  const Eigen::Matrix3d x = skew(phi);
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d sum = term;
  for (int n = 2; n < 20; ++n) {
    term = term * x / n;
    sum += term;
  }
  return sum;
}

/// d(R(phi) q + t)/d(t, phi).
Eigen::Matrix<double, 3, 6> motionDerivative(const Eigen::Vector3d& rotated, const Eigen::Vector3d& phi)
{
  Eigen::Matrix<double, 3, 6> derivative;
  derivative << Eigen::Matrix3d::Identity(), -skew(rotated) * rotationJacobian(phi);
  return derivative;
}

/// A factor's residual as a function of a perturbation of the pose (translation, rotation vector), of which the point
/// follows its share: q' = R(d) q + t(d), d = share * pose.
class PerturbationCost : public ceres::SizedCostFunction<3, 6> {
public:
  PerturbationCost(const Correspondence& correspondence, double share, const DegreesOfFreedom& locked)
      : factor_(correspondence.factor), point_(correspondence.point), share_(share), free_(Vector6::Ones())
  {
    for (std::size_t i = 0; i < locked.size(); ++i) {
      free_[static_cast<int>(i)] = locked[i] ? 0.0 : 1.0;
    }
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override
  {
    const Vector6 perturbation = share_ * Eigen::Map<const Vector6>(parameters[0]);
    const Eigen::Vector3d phi = perturbation.tail<3>();
    const Eigen::Vector3d rotated = expSO3(phi) * point_;
    Eigen::Map<Eigen::Vector3d>{residuals} = factor_.residual(rotated + perturbation.head<3>());
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>>{jacobians[0]} =
          share_ * factor_.derivative() * motionDerivative(rotated, phi) * free_.asDiagonal();
    }
    return true;
  }

private:
  Factor factor_;
  Eigen::Vector3d point_;  ///< without perturbation
  double share_;           ///< of the perturbation
  Vector6 free_;           ///< 0 for a locked degree of freedom, else 1
};

void addResiduals(const std::vector<Correspondence>& correspondences, const SweepModel& model,
                  const DegreesOfFreedom& locked, ceres::LossFunction* loss, Vector6& perturbation,
                  ceres::Problem& ceres_problem)
{
  for (const Correspondence& c : correspondences) {
    if (c.weight > 0.0) {
      const double share = model.follows_pose ? 1.0 + model.sweep_per_motion * c.since_reference : 1.0;
      ceres_problem.AddResidualBlock(new PerturbationCost(c, share, locked),
                                     new ceres::ScaledLoss(loss, c.weight, ceres::DO_NOT_TAKE_OWNERSHIP),
                                     perturbation.data());
    }
  }
}

/// Equations of the perturbation as residuals: sqrt(d) (v^T x + v^T b / d) for each eigenvalue d of H and its v.
class EquationsCost : public ceres::SizedCostFunction<6, 6> {
public:
  EquationsCost(const PoseEquations& equations, const DegreesOfFreedom& locked)
  {
    Vector6 gradient = equations.gradient;
    for (int i = 0; i < 6; ++i) {
      gradient[i] = isLocked(locked, i) ? 0.0 : gradient[i];
    }
    const EigenAnalysis axes = analyse(withLocked(equations.information, locked, 0.0));
    const double negligible = 1e-12 * axes.values[5];
    for (int i = 0; i < 6; ++i) {
      const double d = axes.values[i];
      if (d > negligible) {
        derivative_.row(i) = std::sqrt(d) * axes.vectors.col(i).transpose();
        residual_[i] = axes.vectors.col(i).dot(gradient) / std::sqrt(d);
      }
    }
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override
  {
    Eigen::Map<Vector6>{residuals} = residual_ + derivative_ * Eigen::Map<const Vector6>(parameters[0]);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor6>{jacobians[0]} = derivative_;
    }
    return true;
  }

private:
  using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor | Eigen::DontAlign>;
  RowMajor6 derivative_ = RowMajor6::Zero();
  Vector6 residual_ = Vector6::Zero();
};

}  // namespace

Vector6 solveWithCeres(const RegistrationProblem& problem, const SweepModel& model,
                       const Correspondences& correspondences, const KernelScales& scales, const PoseEquations& besides)
{
  // The losses must outlive the problem, which only borrows them.
  const auto edge_loss = makeLoss(problem.parameters.kernel, scales.edge);
  const auto plane_loss = makeLoss(problem.parameters.kernel, scales.plane);
  Vector6 perturbation = Vector6::Zero();
  ceres::Problem ceres_problem;
  addResiduals(correspondences.edges, model, problem.parameters.locked, edge_loss.get(), perturbation, ceres_problem);
  addResiduals(correspondences.planes, model, problem.parameters.locked, plane_loss.get(), perturbation, ceres_problem);
  ceres_problem.AddResidualBlock(new EquationsCost(besides, problem.parameters.locked), nullptr, perturbation.data());

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 10;
  options.num_threads = 1;  // Ceres' sums depend on the number of threads, ours may not
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  if (!summary.IsSolutionUsable()) {
    return Vector6::Zero();
  }
  // Its rotation vector is exp's, its translation is applied after it: the twist of the same motion.
  return log(SE3(expSO3(perturbation.tail<3>()), perturbation.head<3>()));
}

}  // namespace pcl_floam
