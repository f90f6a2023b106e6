#include "common/parameter_check.h"
#include "odometry/scan_tracking.h"

#include <pcl_floam/odometry/odometry.h>

#include <stdexcept>
#include <utility>

namespace pcl_floam {

const char* toString(TrackingState state)
{
  switch (state) {
    case TrackingState::initialized: return "initialized";
    case TrackingState::tracked: return "tracked";
    case TrackingState::predicted: return "predicted";
    case TrackingState::not_started: return "not started";
  }
  return "unknown";
}

void validate(const OdometryParameters& p)
{
  const ParameterCheck check("odometry");
  check.range("vertical_correction", p.vertical_correction, -10.0, 10.0);
  check.atLeast("scan_period", p.scan_period, 0.0);
  check.range("threads", p.threads, 1, 1024);
  check.atLeast("keyframe translation", p.keyframe.translation, 0.0);
  check.atLeast("keyframe rotation", p.keyframe.rotation, 0.0);
  validate(p.features);
  validate(p.registration);
  validate(p.map);
}

OdometryPipeline::OdometryPipeline(const OdometryParameters& parameters)
{
  validate(parameters);
  impl_ = std::make_unique<Impl>(parameters);
}

OdometryPipeline::OdometryPipeline(const OdometryPipeline& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
OdometryPipeline::OdometryPipeline(OdometryPipeline&& other) noexcept = default;
OdometryPipeline& OdometryPipeline::operator=(OdometryPipeline&& other) noexcept = default;
OdometryPipeline::~OdometryPipeline() = default;

OdometryPipeline& OdometryPipeline::operator=(const OdometryPipeline& other)
{
  impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}

const OdometryReport& OdometryPipeline::track(const CloudView& scan, std::optional<double> stamp)
{
  return impl_->track(scan, stamp);
}

const OdometryReport& OdometryPipeline::trackMissing(std::optional<double> stamp)
{
  impl_->beginScan(0, stamp);
  return impl_->seeNothing("the scan is missing");
}

const OdometryReport& OdometryPipeline::report() const
{
  return impl_->report;
}

SE3 OdometryPipeline::pose() const
{
  return impl_->report.world_T_sensor;
}

const KeyframeVoxelMap& OdometryPipeline::map() const
{
  return impl_->map;
}

const OdometryParameters& OdometryPipeline::parameters() const
{
  return impl_->parameters;
}

void OdometryPipeline::localizeIn(KeyframeVoxelMap map, const SE3& world_T_sensor, MapUse use)
{
  if (map.empty()) {
    throw std::invalid_argument("the map to localise in is empty");
  }
  if (!world_T_sensor.isFinite()) {
    throw std::invalid_argument("the pose to begin with is not finite");
  }
  reset(world_T_sensor);
  impl_->map = std::move(map);
  impl_->prior_map = use;
  impl_->started = true;
  impl_->motion.begin(world_T_sensor);
  impl_->world_T_keyframe = world_T_sensor;
}

void OdometryPipeline::reset(const SE3& world_T_sensor)
{
  const OdometryParameters parameters = impl_->parameters;
  impl_ = std::make_unique<Impl>(parameters);
  impl_->initial_pose = world_T_sensor;
  impl_->report.world_T_sensor = world_T_sensor;
}

}  // namespace pcl_floam
