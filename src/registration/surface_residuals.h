/// \file surface_residuals.h
/// How far a sweep's points are from the surfaces of a map, summed up.
#pragma once

#include "registration/normal_equations.h"
#include "registration/placed_points.h"
#include "registration/sampling_pattern.h"

#include <array>
#include <cstddef>
#include <vector>

namespace pcl_floam {

/// What some of the residuals come to: the twist of the equations is the velocity, their squares are counted by the
/// robust weights alone, and lines are edges.
struct SurfaceSums {
  NormalEquations equations;
  double robust_weight = 0.0;

  void add(const SurfaceSums& other);
};

/// Of all residuals of a sweep.
struct SweepSums {
  SurfaceSums scan;
  SurfaceSums edges;  ///< the paper's features

  [[nodiscard]] SurfaceSums total() const
  {
    SurfaceSums sums = scan;
    sums.add(edges);
    return sums;
  }
};

/// Memory of one registration, which the next one may use again.
struct SurfaceRoom {
  std::vector<SurfaceSums> parts;   ///< of the chunks
  std::vector<Pulls> pulls;         ///< of the chunks
  std::vector<FoundSurface> edges;  ///< by the edge
};

/// The residuals at one estimate of pose and motion.
struct SurfaceResiduals {
  SweepTrajectory sensor;                      ///< its reference is mid-sweep
  Matrix6 pose_uncertainty = Matrix6::Zero();  ///< covariance of what the pose may still be off: it widens the kernel
  double periods = 0.0;  ///< of the sweep, as far as the velocity that is sought places its points
  int threads = 1;

  /// In fixed chunks, added in order: the same bits for every number of threads.
  /// \param stride      one of the scan's points in so many
  /// \param edge_stride of the edges
  [[nodiscard]] SweepSums sumsOf(const SurfaceTerm& scan, std::size_t stride, const SurfaceTerm& edges,
                                 std::size_t edge_stride, SurfaceRoom& room) const;

  /// Of the same residuals along some motions of the pose alone: of the scan's points some, but all edges, since of a
  /// weak direction few of them tell.
  [[nodiscard]] Pulls pullsAlong(const TriedMotions& motions, const SurfaceTerm& scan, const SurfaceTerm& edges,
                                 SurfaceRoom& room) const;

private:
  /// \tparam Rows take the residuals: of a chunk, or along some motions
  template <typename Rows>
  void addAll(const PlacedPoints& placed, Rows& rows, SurfaceSums& sums) const;
  template <typename Rows>
  void addPlane(const PlacedPoint& point, const Surface& plane, Rows& rows, SurfaceSums& sums) const;
  template <typename Rows>
  void addLine(const PlacedPoint& point, const Surface& line, Rows& rows, SurfaceSums& sums) const;
  template <typename Rows>
  void addPoint(const PlacedPoint& point, const Surface& near, Rows& rows, SurfaceSums& sums) const;
  [[nodiscard]] Eigen::Vector3d turned(const std::array<float, 3>& run) const;
  [[nodiscard]] double weight(double squared, double variance, const Vector6& derivative, const PlacedPoint& p,
                              SurfaceSums& sums) const;
};

}  // namespace pcl_floam
