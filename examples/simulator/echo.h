/// \file echo.h
/// What a pulse of light brings back: from a footprint, by way of mirrors, through weather.
#pragma once

#include "lidar.h"
#include "ray_scene.h"
#include "sensor_errors.h"
#include "weather.h"

#include <pcl_floam/common/se3.h>

#include <optional>

namespace pcl_floam::simulator {

/// One pulse.
struct Pulse {
  SE3 world_T_sensor;
  Eigen::Vector3d beam;   ///< its direction in the sensor's frame
  double fraction = 0.0;  ///< of the sweep at which it is sent
};

/// A pulse's echo.
struct Echo {
  RayHit hit;
  bool ghost = false;  ///< no surface is there: a mirror image, rain, snow, dust or stray light
};

/// Sends pulses into a scene.
class EchoModel {
public:
  EchoModel(const Lidar& lidar, const SensorErrors& errors, const Weather& weather)
      : lidar_(lidar), errors_(errors), weather_(weather)
  {
  }

  /// The echo that is told of, if any is strong enough.
  [[nodiscard]] std::optional<Echo> echo(const RayScene& scene, const Pulse& pulse, Random& random) const;

private:
  /// Where a pulse has met a glossy surface.
  struct Surface {
    Eigen::Vector3f place;
    float distance;  // m, on the way so far
  };

  [[nodiscard]] RayHit footprint(const RayScene& scene, const Pulse& pulse, Random& random) const;
  [[nodiscard]] std::optional<RayHit> follow(const RayScene& scene, const Pulse& pulse, const Surface& surface,
                                             const Eigen::Vector3f& direction, double share, Random& random) const;
  [[nodiscard]] std::optional<Echo> echoByGloss(const RayScene& scene, const Pulse& pulse, const RayHit& hit,
                                                Random& random) const;
  [[nodiscard]] bool detects(RayHit& hit, double share, Random& random) const;

  Lidar lidar_;
  SensorErrors errors_;
  Weather weather_;
};

}  // namespace pcl_floam::simulator
