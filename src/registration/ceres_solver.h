/// \file ceres_solver.h
/// The second solver: Ceres' trust region on the same factors.
#pragma once

#include "registration/correspondences.h"
#include "registration/normal_equations.h"
#include "registration/sweep_step.h"

#include <optional>

namespace pcl_floam {

/// The step that minimises the robust weighted cost (Eq. 10) of fixed correspondences, by Ceres.
/// Zero if Ceres finds no usable solution.
/// \param prior of a sweep whose twist is estimated, too; without one only the pose moves
[[nodiscard]] SweepStep solveWithCeres(const RegistrationProblem& problem, const SweepModel& model,
                                       const Correspondences& correspondences, const KernelScales& scales,
                                       const std::optional<MotionPriorTerm>& prior);

}  // namespace pcl_floam
