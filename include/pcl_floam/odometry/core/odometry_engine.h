/// \file odometry_engine.h
/// The choice between the library's registration by surfaces and the paper's by features.
#pragma once

#include <cstdint>

namespace pcl_floam {

enum class OdometryEngine : std::uint8_t {
  /// The paper's own pipeline, and the quicker one: its features, with the nearest points of the map. Needs scan lines.
  /// On open roads and motorways the sensor's own rings on the ground look like rest to it.
  features,
  /// Points taken by space, with surfaces of a pyramid of voxels that remembers which lasers saw them, and the paper's
  /// edges, with lines through those of the map. Holds on open roads, and for lidars without scan lines. Of the
  /// registration's parameters it uses `locked` alone.
  surfaces
};

[[nodiscard]] const char* toString(OdometryEngine engine);

}  // namespace pcl_floam
