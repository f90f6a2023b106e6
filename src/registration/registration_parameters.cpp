#include <pcl_floam/registration/core/registration_parameters.h>

#include <pcl_floam/registration/core/registration_report.h>

namespace pcl_floam {

const char* toString(WeightScheme scheme)
{
  switch (scheme) {
    case WeightScheme::uniform: return "uniform";
    case WeightScheme::inverted: return "inverted";
    case WeightScheme::printed: return "printed";
  }
  return "unknown";
}

const char* toString(RobustKernel kernel)
{
  switch (kernel) {
    case RobustKernel::none: return "none";
    case RobustKernel::huber: return "huber";
    case RobustKernel::cauchy: return "cauchy";
    case RobustKernel::geman_mcclure: return "geman-mcclure";
  }
  return "unknown";
}

const char* toString(SolverKind solver)
{
  return solver == SolverKind::gauss_newton ? "gauss-newton" : "ceres";
}

const char* toString(Termination termination)
{
  switch (termination) {
    case Termination::not_run: return "not run";
    case Termination::converged: return "converged";
    case Termination::iteration_limit: return "iteration limit reached";
    case Termination::too_few_features: return "too few features";
    case Termination::empty_target: return "nothing to register against";
    case Termination::too_few_correspondences: return "too few correspondences";
    case Termination::degenerate: return "the correspondences constrain no pose";
    case Termination::invalid_input: return "the guess is not finite";
  }
  return "unknown";
}

}  // namespace pcl_floam
