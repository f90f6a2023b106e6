/// \file surface_residuals.h
/// How far a sweep's points are from the surfaces of a map, summed up.
#pragma once

#include "common/sweep_trajectory.h"
#include "registration/normal_equations.h"
#include "registration/surface_registration.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace pcl_floam {

class ResidualRows;

/// A point where the present estimate has it.
struct PlacedPoint {
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();    ///< from the sensor
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< in the target's frame
  Eigen::Vector3d run = Eigen::Vector3d::Zero();    ///< \ref ScanPoint::run, in the target's axes
  double since_middle = 0.0;                        ///< in periods: so much of a change of the velocity moves it, too
};

/// What some of the residuals come to: the twist of the equations is the velocity, their squares are counted by the
/// robust weights alone, and lines are edges.
struct SurfaceSums {
  NormalEquations equations;
  double robust_weight = 0.0;
  double evidence = 0.0;

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

/// What was found at a place.
struct FoundSurface {
  Eigen::Vector3d at = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());  ///< nothing yet
  Surface surface;
};

/// Memory of one registration, which the next one may use again.
struct SurfaceRoom {
  std::vector<SurfaceSums> parts;   ///< of the chunks
  std::vector<FoundSurface> edges;  ///< by the edge
  std::vector<float> evidence;      ///< by the point of the scan, if it was weighed
};

/// The residuals at one estimate of pose and motion.
struct SurfaceResiduals {
  SweepTrajectory sensor;           ///< its reference is mid-sweep
  Matrix6 reach = Matrix6::Zero();  ///< covariance of what the pose may still be off: it widens the kernel
  double periods = 0.0;             ///< of the sweep, as far as the velocity that is sought places its points
  bool weighs_evidence = false;     ///< else the sums have none
  bool knows_lasers = true;         ///< else a laser's own curve bears out its points, too
  int threads = 1;

  /// In fixed chunks, added in order: the same bits for every number of threads.
  /// \param stride one of the scan's points in so many
  [[nodiscard]] SweepSums sumsOf(const SurfaceTerm& scan, const SurfaceTerm& edges, std::size_t stride,
                                 SurfaceRoom& room) const;

private:
  [[nodiscard]] SurfaceSums chunkOf(const SurfaceTerm& term, std::size_t chunk, std::size_t stride, FoundSurface* found,
                                    float* evidence) const;
  [[nodiscard]] PlacedPoint placedAt(const Eigen::Vector3d& undistorted, const ScanPoint& point) const;
  void addPlane(const PlacedPoint& point, const Surface& plane, ResidualRows& rows, ResidualRows& noise,
                SurfaceSums& sums) const;
  void addLine(const PlacedPoint& point, const Surface& line, ResidualRows& rows, ResidualRows& noise,
               SurfaceSums& sums) const;
  void addPoint(const PlacedPoint& point, const Surface& near, ResidualRows& rows, SurfaceSums& sums) const;
  [[nodiscard]] double weight(double squared, double variance, const Eigen::Vector3d& direction, const PlacedPoint& p,
                              SurfaceSums& sums) const;
  void weighEvidence(double squared, double variance, double dimensions, SurfaceSums& sums) const;
};

}  // namespace pcl_floam
