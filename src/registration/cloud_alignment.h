/// \file cloud_alignment.h
/// The estimate of one registration of clouds, which goes from level to level.
#pragma once

#include "registration/cloud_matching.h"
#include "registration/cloud_pyramid.h"
#include "registration/information_analysis.h"
#include "registration/pose_factors.h"

#include <pcl_floam/common/se3.h>
#include <pcl_floam/registration/core/cloud_registration.h>

namespace pcl_floam {

/// How much directions along surfaces count on full clouds: enough to hold a cloud where surfaces do not, too little to
/// pull at one that may slide.
constexpr double kAlongSurfaces = 1e-3;

/// A pose between two clouds, improved on one level at a time. Poses are between the pyramids' origins.
class CloudAlignment {
public:
  CloudAlignment(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run);

  /// Iterates until no typical point moves by \p epsilon (m) or \p most iterations were done.
  /// \param watched whether the user sees each iteration, and may end it
  Termination align(CloudMatching& alignment, int most, double epsilon, bool watched);

  [[nodiscard]] const SE3& pose() const { return pose_; }
  void setPose(const SE3& pose) { pose_ = pose; }

  /// What the matches of a level and the factors say of the present pose.
  [[nodiscard]] NormalEquations evaluate(CloudMatching& level) const;

  /// Moves by a perturbation, which turns about the source's centroid.
  void move(const Vector6& perturbation);

  /// Keeps steps from perturbations like these, one a column.
  void hold(const Motions& perturbations) { held_ = perturbations; }
  [[nodiscard]] SE3 toFrames(const SE3& pose) const { return target_T_origin_ * pose * source_T_origin_.inverse(); }

  // Of the last iteration.
  [[nodiscard]] const NormalEquations& sums() const { return sums_; }
  [[nodiscard]] int iterations() const { return iterations_; }  ///< of the last align()
  [[nodiscard]] InformationAnalysis analysis() const
  {
    return InformationAnalysis(sums_, 0.0, freeMotions(run_.locked, arm()), held_);
  }

  /// From the source's frame's origin to its centroid, in the target's axes.
  [[nodiscard]] Eigen::Vector3d arm() const { return pose_.rotation * source_T_origin_.translation; }

private:
  bool take(const Vector6& step, const CloudMatching& alignment, bool watched);

  const CloudRegistrationRun& run_;
  PoseFactors factors_;
  double extent_;
  Motions held_ = Motions(6, 0);
  SE3 source_T_origin_;
  SE3 target_T_origin_;
  SE3 pose_;
  NormalEquations sums_;
  int iterations_ = 0;
};

}  // namespace pcl_floam
