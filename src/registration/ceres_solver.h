/// \file ceres_solver.h
/// The second solver: Ceres' trust region on the same factors.
#pragma once

#include "registration/correspondences.h"
#include "registration/normal_equations.h"

namespace pcl_floam {

/// The left perturbation that minimises the robust weighted cost (Eq. 10) of fixed correspondences, by Ceres.
/// Zero if Ceres finds no usable solution.
[[nodiscard]] Vector6 solveWithCeres(const RegistrationProblem& problem, const SE3& local_T_sensor,
                                     const Correspondences& correspondences, const KernelScales& scales);

}  // namespace pcl_floam
