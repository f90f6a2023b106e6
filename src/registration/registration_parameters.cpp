#include <pcl_floam/registration/registration_parameters.h>

#include "common/parameter_check.h"

#include <pcl_floam/map/neighbor_search.h>
#include <pcl_floam/registration/registration_report.h>

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

const char* toString(WeightNormalization normalization)
{
  return normalization == WeightNormalization::mean_one ? "mean-one" : "sum-one";
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

void validate(const RegistrationParameters& p)
{
  const ParameterCheck check("registration");
  check.range("max_iterations", p.max_iterations, 1, 1000);
  check.above("max_neighbor_distance", p.max_neighbor_distance, 0.0);
  check.above("edge_weight", p.edge_weight, 0.0);
  check.range("max_features", p.max_features, 100, 1000000);
  check.range("min_correspondences", p.min_correspondences, 6, 1000000);
}

}  // namespace pcl_floam
