/// \file surface_evidence.h
/// How well a map explains a sweep where an estimate has it.
#pragma once

#include "registration/placed_points.h"

#include <vector>

namespace pcl_floam {

/// Log-likelihoods per independent residual, over those of points that may be anywhere within a metre.
struct SurfaceEvidence {
  SweepTrajectory sensor;  ///< its reference is mid-sweep
  int threads = 1;

  /// Of all points and edges: the same bits for every number of threads.
  /// \param found lines of the edges
  /// \param[out] of_points each point's of the scan; nullptr: they are not asked for
  [[nodiscard]] double of(const SurfaceTerm& scan, const SurfaceTerm& edges, std::vector<FoundSurface>& found,
                          std::vector<float>* of_points) const;
};

}  // namespace pcl_floam
