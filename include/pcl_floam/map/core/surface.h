/// \file surface.h
/// What a map knows of a place, and the interface through which a registration asks for it.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

namespace pcl_floam {

/// The shape of what was seen near a place.
enum class SurfaceKind : std::uint8_t {
  unknown,  ///< nothing, or nothing that several lasers support and noise does not hide
  plane,
  line,
  point  ///< neither: the nearest point seen there
};

/// A piece of surface. Plain members of no alignment: it crosses the border between code of different flags.
struct Surface {
  SurfaceKind kind = SurfaceKind::unknown;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();     ///< m, world frame: mean of its points; for `point` the nearest
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit: the plane's normal or the line's direction
  /// Of a `point`: which displacements show there, 0 to 1 by direction; some of that is chance, and counted as
  /// such. What fills its cell, or the one around that, evenly goes on beyond it, and tells nothing of the way along
  /// it; nor does what lies in a cell of the greatest side.
  Eigen::Matrix3d observability = Eigen::Matrix3d::Identity();
  double thickness = 0.0;   ///< m^2: variance of its points across it; for `point` the squared spacing of the points
  double extent = 0.0;      ///< m^2: variance of its points along it, in the shorter direction of a plane
  std::uint32_t count = 0;  ///< of the points it was found from
  /// Unit: the direction in which a plane's points are spread farthest; zero: not known, and it is as good as the
  /// other.
  Eigen::Vector3d wide = Eigen::Vector3d::Zero();
  double width = 0.0;  ///< m^2: variance of the points along \ref wide; 0: not known
};

/// Where a registration looks for surfaces. One's own is handed to an odometry as a \ref SurfaceMap
/// (OdometryComponents::map), which adds keyframes, too.
class SurfaceSearch {
public:
  virtual ~SurfaceSearch() = default;

  /// True when there is nothing to be found.
  [[nodiscard]] virtual bool empty() const = 0;

  /// The surface at each of \p count places; `unknown` where there is none. Safe to call from several threads.
  /// \param places   world frame, m; one that is not finite has none
  /// \param surfaces room for \p count answers
  virtual void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const = 0;
};

}  // namespace pcl_floam
