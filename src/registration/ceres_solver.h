/// \file ceres_solver.h
/// The second solver: Ceres' trust region on the same factors.
#pragma once

#include "registration/correspondences.h"
#include "registration/normal_equations.h"

#include <pcl_floam/registration/core/pose_factor.h>
#include <pcl_floam/registration/core/sweep_model.h>

namespace pcl_floam {

/// The step that minimises the robust weighted cost (Eq. 10) of fixed correspondences, by Ceres.
/// Zero if Ceres finds no usable solution.
/// \param besides what else is known of the pose, about the local origin
[[nodiscard]] Vector6 solveWithCeres(const RegistrationProblem& problem, const SweepModel& model,
                                     const Correspondences& correspondences, const KernelScales& scales,
                                     const PoseEquations& besides = {});

}  // namespace pcl_floam
