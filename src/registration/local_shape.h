/// \file local_shape.h
/// What a cloud looks like around each of its points: a line, a plane or neither.
#pragma once

#include "registration/point_tree.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pcl_floam {

enum class ShapeKind : std::uint8_t { point, line, plane };

/// The shape of a point's neighbourhood, from the eigenvalues of its covariance.
struct LocalShape {
  ShapeKind kind = ShapeKind::point;
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();  ///< direction of a line, normal of a plane; unit
  /// From the point to the line or plane, m: what noise has moved it by.
  Eigen::Vector3f to_surface = Eigen::Vector3f::Zero();

  /// The covariance of where the point may lie on the surface that it stands for, relative to the spread along the
  /// surface: \p across (much below 1) across a line or plane, 1 along it and in every direction of neither.
  [[nodiscard]] Eigen::Matrix3d covariance(double across) const
  {
    const Eigen::Vector3d direction = axis.cast<double>();
    const Eigen::Matrix3d outer = direction * direction.transpose();
    switch (kind) {
      case ShapeKind::line: return across * Eigen::Matrix3d::Identity() + (1.0 - across) * outer;
      case ShapeKind::plane: return Eigen::Matrix3d::Identity() - (1.0 - across) * outer;
      case ShapeKind::point: break;
    }
    return Eigen::Matrix3d::Identity();
  }
};

/// The shapes around all points of a tree, in its order.
struct LocalShapes {
  std::vector<LocalShape> shape;
  double spacing = 0.0;  ///< typical distance of neighbours on a surface, m; 0 if all points are equal
};

/// How a tree's points lie around some places.
struct Sampling {
  double spacing = 0.0;    ///< as of LocalShapes
  bool in_lines = false;   ///< rather than over surfaces
  double shapeless = 0.0;  ///< part of the neighbourhoods that are neither lines nor planes
};

[[nodiscard]] Sampling findSampling(const PointTree& tree, const std::vector<Eigen::Vector3f>& places);

[[nodiscard]] LocalShapes findLocalShapes(const PointTree& tree, int threads);

}  // namespace pcl_floam
