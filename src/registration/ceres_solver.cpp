#include "registration/ceres_solver.h"

#include "registration/motion_model.h"

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

/// A factor's residual as a function of delta = (translation, rotation vector): q' = R(delta) q + t(delta).
template <typename Factor>
class PerturbationCost : public ceres::SizedCostFunction<Factor::kResiduals, 6> {
public:
  PerturbationCost(const Factor& factor, Eigen::Vector3d point, double response)
      : factor_(factor), point_(std::move(point)), response_(response)
  {
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override
  {
    const Eigen::Map<const Eigen::Vector3d> translation(parameters[0]);
    const Eigen::Vector3d phi = response_ * Eigen::Map<const Eigen::Vector3d>(parameters[0] + 3);
    const Eigen::Vector3d rotated = expSO3(phi) * point_;
    Eigen::Map<Eigen::Matrix<double, Factor::kResiduals, 1>> residual(residuals);
    residual = factor_.residual(rotated + response_ * translation);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Matrix<double, 3, 6> motion = RigidMotion::derivative(rotated, response_);
      motion.rightCols<3>() = (motion.rightCols<3>() * rotationJacobian(phi)).eval();
      const Eigen::Matrix<double, Factor::kResiduals, 6> jacobian = factor_.derivative() * motion;
      for (int row = 0; row < Factor::kResiduals; ++row) {
        for (int column = 0; column < 6; ++column) {
          jacobians[0][row * 6 + column] = jacobian(row, column);
        }
      }
    }
    return true;
  }

private:
  Factor factor_;
  Eigen::Vector3d point_;  ///< in the target's axes, relative to the local origin, at delta = 0
  double response_;        ///< how much of delta the point follows
};

template <typename Factor>
void addResiduals(const std::vector<Correspondence<Factor>>& correspondences, const SE3& local_T_sensor,
                  ceres::LossFunction* loss, double* delta, ceres::Problem& ceres_problem)
{
  for (const auto& c : correspondences) {
    if (c.weight > 0.0) {
      ceres_problem.AddResidualBlock(new PerturbationCost<Factor>(c.factor, local_T_sensor * c.point, c.response),
                                     new ceres::ScaledLoss(loss, c.weight, ceres::DO_NOT_TAKE_OWNERSHIP), delta);
    }
  }
}

}  // namespace

Vector6 solveWithCeres(const RegistrationProblem& problem, const SE3& local_T_sensor,
                       const Correspondences& correspondences, const KernelScales& scales)
{
  // The losses must outlive the problem, which only borrows them.
  const auto edge_loss = makeLoss(problem.parameters.kernel, scales.edge);
  const auto plane_loss = makeLoss(problem.parameters.kernel, scales.plane);
  double delta[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  ceres::Problem ceres_problem;
  addResiduals(correspondences.edges, local_T_sensor, edge_loss.get(), delta, ceres_problem);
  addResiduals(correspondences.planes, local_T_sensor, plane_loss.get(), delta, ceres_problem);

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
  // The rotation vector is exp's; the translation is applied after it: convert to the twist of the same motion.
  const Eigen::Map<const Eigen::Vector3d> translation(delta);
  const Eigen::Vector3d phi = Eigen::Map<const Eigen::Vector3d>(delta + 3);
  return log(SE3(expSO3(phi), translation));
}

}  // namespace pcl_floam
