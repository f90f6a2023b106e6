#include "odometry/scan_registration.h"

#include "registration/feature_sampling.h"

#include <optional>
#include <utility>

namespace pcl_floam {

namespace {

/// Nothing if there are too few features to leave some of them out.
std::optional<FeatureSet> spreadPart(const FeatureSet& features)
{
  const auto count = [](const FeatureSet& set) { return set.edges.size() + set.planes.size(); };
  FeatureSet sample = spreadSample(features);
  return count(sample) < count(features) ? std::make_optional(std::move(sample)) : std::nullopt;
}

}  // namespace

RegistrationReport ScanRegistration::registerScan(const FeatureSet& measured, const FeatureTarget& target,
                                                  const RegistrationRun& run, const RegistrationParameters& parameters)
{
  const bool compares = crowding_.isDue();
  used_spread_features_ = false;
  if (crowding_.misleads() && !compares) {
    const auto sample = spreadPart(measured);
    const RegistrationReport spread =
        sample ? registerFeatures(*sample, target, run, parameters) : RegistrationReport();
    used_spread_features_ = spread.hasConverged();
    return used_spread_features_ ? spread : registerFeatures(measured, target, run, parameters);
  }
  RegistrationReport all = registerFeatures(measured, target, run, parameters);
  if (!compares && all.hasConverged()) {
    return all;
  }
  const auto sample = spreadPart(measured);
  if (!sample) {
    return all;
  }
  RegistrationRun second = run;
  if (!crowding_.misleads() && all.hasConverged() && all.weak_directions.empty()) {
    second.guess = all.target_T_source;  // mostly they agree, and this is the shorter way
    second.guess_uncertainty = 0.0;
  }
  const RegistrationReport spread = registerFeatures(*sample, target, second, parameters);
  crowding_.compare(all, spread);
  used_spread_features_ = spread.hasConverged() && (crowding_.misleads() || !all.hasConverged());
  return used_spread_features_ ? spread : all;
}

}  // namespace pcl_floam
