#include "settings_json.h"

#include "text_format.h"

namespace pcl_floam::tools {

namespace {

using Json = nlohmann::ordered_json;

/// The double with the fewest digits that is the float: 0.04, not 0.03999999910593033.
double shortest(float value)
{
  return std::stod(formatted("%.6g", static_cast<double>(value)));
}

Json featuresJson(const FeatureParameters& p)
{
  return {{"smoothness", toString(p.smoothness)},
          {"edges_per_sector", p.edges_per_sector},
          {"planes_per_sector", p.planes_per_sector},
          {"min_range_m", shortest(p.min_range)},
          {"max_range_m", shortest(p.max_range)},
          {"edge_threshold_m", shortest(p.edge_threshold)},
          {"plane_threshold_m", shortest(p.plane_threshold)}};
}

Json registrationJson(const RegistrationParameters& p)
{
  return {{"solver", toString(p.solver)},
          {"weights", toString(p.weights)},
          {"kernel", toString(p.kernel)},
          {"locked_x_y_z_rx_ry_rz", p.locked}};
}

Json mapJson(const OdometryParameters& p)
{
  return {{"keyframe_translation_m", p.keyframe.translation},
          {"voxel_size_m", p.map.voxel_size},
          {"horizon_m", p.map.horizon},
          {"see_through_range_m", p.map.see_through_range},
          {"search", toString(p.map.search)}};
}

}  // namespace

Json toJson(const OdometryParameters& p)
{
  Json json = {{"engine", toString(p.engine)},
               {"sensor", p.sensor.name},
               {"timing", toString(p.timing_source)},
               {"vertical_correction_deg", p.vertical_correction},
               {"scan_period_s", p.scan_period},
               {"compensation", toString(p.compensation)},
               {"pose_instant", toString(p.pose_instant)},
               {"start_effort", p.start_effort},
               {"threads", p.threads}};
  json["features"] = featuresJson(p.features);
  json["registration"] = registrationJson(p.registration);
  json["map"] = mapJson(p);
  return json;
}

}  // namespace pcl_floam::tools
