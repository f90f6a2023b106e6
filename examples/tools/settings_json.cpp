#include "settings_json.h"

#include "text_format.h"

namespace pcl_floam::tools {

namespace {

using Json = nlohmann::ordered_json;

const char* nameOf(ScanRotation rotation)
{
  switch (rotation) {
    case ScanRotation::automatic: return "automatic";
    case ScanRotation::clockwise: return "clockwise";
    case ScanRotation::counterclockwise: return "counterclockwise";
  }
  return "unknown";
}

/// The double with the fewest digits that is the float: 0.04, not 0.03999999910593033.
double shortest(float value)
{
  return std::stod(formatted("%.6g", static_cast<double>(value)));
}

Json featuresJson(const FeatureParameters& p)
{
  return {{"smoothness", toString(p.smoothness)},
          {"sectors", p.sectors},
          {"edges_per_sector", p.edges_per_sector},
          {"planes_per_sector", p.planes_per_sector},
          {"min_range_m", shortest(p.min_range)},
          {"max_range_m", shortest(p.max_range)},
          {"edge_threshold_m", shortest(p.edge_threshold)},
          {"edge_bend", shortest(p.edge_bend)},
          {"plane_threshold_m", shortest(p.plane_threshold)}};
}

Json registrationJson(const RegistrationParameters& p)
{
  return {{"solver", toString(p.solver)},
          {"weights", toString(p.weights)},
          {"weight_normalization", toString(p.weight_normalization)},
          {"edge_weight", p.edge_weight},
          {"kernel", toString(p.kernel)},
          {"max_iterations", p.max_iterations},
          {"max_neighbor_distance_m", p.max_neighbor_distance},
          {"max_features", p.max_features},
          {"min_correspondences", p.min_correspondences},
          {"locked_x_y_z_rx_ry_rz", p.locked}};
}

Json mapJson(const OdometryParameters& p)
{
  return {{"keyframe_translation_m", p.keyframe.translation},
          {"keyframe_rotation_rad", p.keyframe.rotation},
          {"edge_voxel_size_m", p.map.edge_voxel_size},
          {"plane_voxel_size_m", p.map.plane_voxel_size},
          {"horizon_m", p.map.horizon},
          {"see_through_range_m", p.map.see_through_range},
          {"search", toString(p.map.search)}};
}

}  // namespace

Json toJson(const OdometryParameters& p)
{
  Json json = {{"engine", toString(p.engine)},
               {"sensor", p.sensor.name},
               {"structure", toString(p.structure)},
               {"scan_lines", toString(p.scan_line_source)},
               {"timing", toString(p.timing_source)},
               {"rotation", nameOf(p.rotation)},
               {"vertical_correction_deg", p.vertical_correction},
               {"scan_period_s", p.scan_period},
               {"compensation", toString(p.compensation)},
               {"pose_instant", toString(p.pose_instant)},
               {"threads", p.threads}};
  json["features"] = featuresJson(p.features);
  json["registration"] = registrationJson(p.registration);
  json["map"] = mapJson(p);
  return json;
}

}  // namespace pcl_floam::tools
