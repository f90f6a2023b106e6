/// \file surface_fit.h
/// The shape of a cell's points from their running sums.
#pragma once

#include "map/laser_support.h"

#include <pcl_floam/map/surface.h>

#include <Eigen/Core>

#include <array>
#include <atomic>
#include <cstdint>

namespace pcl_floam {

/// Which shapes a map looks for.
enum class SurfaceShapes : std::uint8_t {
  all,
  lines  ///< of edge features: all that they tell is where a line is
};

/// Count, sum and sum of outer products of points about a common origin, and the lasers that saw them.
struct CellSums {
  std::array<double, 3> sum{};
  std::array<double, 6> outer{};  // xx xy xz yy yz zz
  LaserSupport support;
  std::uint32_t count = 0;

  void add(double x, double y, double z);
};

/// What the sums tell. Offsets are from the sums' origin.
struct CellFit {
  SurfaceKind kind = SurfaceKind::unknown;
  std::array<float, 3> mean{};
  std::array<float, 3> direction{};
  std::array<float, 9> axes{};    ///< of a point's cell: its principal directions, one after the other
  std::array<float, 6> filled{};  ///< xx xy xz yy yz zz: covariance over that of points that fill the cell evenly
  float thickness = 0.0F;
  float extent = 0.0F;
};

/// A shape that chance or the sampling pattern of a single laser would give is none.
/// \param side m, of the cell
[[nodiscard]] CellFit fitOf(const CellSums& sums, SurfaceShapes shapes, double side);

/// A fit that is worked out when it is first asked for, by whichever thread asks.
struct CachedFit {
  enum State : std::uint8_t { stale, being_made, ready };

  CellFit fit;
  std::atomic<std::uint8_t> state{stale};

  CachedFit() = default;
  ~CachedFit() = default;
  CachedFit(const CachedFit& other) : fit(other.fit), state(other.state.load()) {}
  CachedFit& operator=(const CachedFit& other)
  {
    fit = other.fit;
    state.store(other.state.load());
    return *this;
  }
};

}  // namespace pcl_floam
