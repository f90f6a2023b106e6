/// \file surface_map.h
/// A map that an odometry registers with and adds to: the interface for maps of one's own.
#pragma once

#include <pcl_floam/map/core/surface.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace pcl_floam {

/// What scans are registered with, and what keyframes enter. The odometry's own is a pyramid of voxels.
///
/// While it is unclear how the sensor began to move, several maps are kept side by side: each is made by \ref makeEmpty
/// or `copy` of another, which several threads may ask for at a time, as \ref find; all else by one. Nothing may
/// throw.
class SurfaceMap : public SurfaceSearch {
public:
  using Ptr = std::shared_ptr<SurfaceMap>;
  using ConstPtr = std::shared_ptr<const SurfaceMap>;

  /// A map like this one with nothing in it.
  /// \param side m, of cells of which the first scan fills some thousand: the scale of what scans tell
  [[nodiscard]] virtual std::unique_ptr<SurfaceMap> makeEmpty(double side) const = 0;

  [[nodiscard]] virtual std::unique_ptr<SurfaceMap> copy() const = 0;

  /// Forgets all. Its memory may be used again.
  virtual void clear() = 0;

  /// Takes in some points of a keyframe.
  /// \param places m, in the map's frame; undistorted
  /// \param lasers the scan line that saw each; without scan lines the part of the sweep, in the cloud's order; points
  ///               of a single layer, and of a map that was made before, have a number each
  virtual void insert(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count) = 0;

  /// Forgets what is farther than \p radius (m) from \p center; whole cells, or nothing if the map need not be small.
  virtual void crop(const Eigen::Vector3d& /*center*/, double /*radius*/) {}
};

}  // namespace pcl_floam
