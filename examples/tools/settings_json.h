/// \file settings_json.h
/// The odometry's settings as JSON.
#pragma once

#include <pcl_floam/odometry/core/odometry_parameters.h>

#include <nlohmann/json.hpp>

namespace pcl_floam::tools {

[[nodiscard]] nlohmann::ordered_json toJson(const OdometryParameters& parameters);

}  // namespace pcl_floam::tools
