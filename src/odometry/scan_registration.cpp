#include "odometry/scan_registration.h"

#include "odometry/first_motion.h"

namespace pcl_floam {

RegistrationReport ScanRegistration::registerScan(const FeatureSet& measured, const FeatureTarget& target,
                                                  const RegistrationRun& run, const RegistrationParameters& parameters)
{
  const bool compares = crowding_.isDue();
  if (crowding_.misleads() && !compares) {
    const RegistrationReport spread = registerFeatures(spreadSample(measured), target, run, parameters);
    used_spread_features_ = spread.hasConverged();
    return used_spread_features_ ? spread : registerFeatures(measured, target, run, parameters);
  }
  const RegistrationReport all = registerFeatures(measured, target, run, parameters);
  used_spread_features_ = false;
  if (!compares && all.hasConverged()) {
    return all;
  }
  RegistrationRun second = run;
  if (!crowding_.misleads() && all.hasConverged()) {  // mostly they agree, and this is the shorter way
    second.guess = all.target_T_source;
    second.guess_uncertainty = 0.0;
  }
  const RegistrationReport spread = registerFeatures(spreadSample(measured), target, second, parameters);
  crowding_.compare(all, spread);
  used_spread_features_ = spread.hasConverged() && (crowding_.misleads() || !all.hasConverged());
  return used_spread_features_ ? spread : all;
}

}  // namespace pcl_floam
