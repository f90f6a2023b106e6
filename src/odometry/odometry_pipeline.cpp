#include "common/parameter_check.h"
#include "odometry/feature_odometry.h"
#include "odometry/scan_repetition.h"
#include "odometry/sensor_frame.h"
#include "odometry/surface_odometry.h"

#include <pcl_floam/common/core/thread_count.h>
#include <pcl_floam/odometry/odometry.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <variant>

namespace pcl_floam {

const char* toString(TrackingState state)
{
  switch (state) {
    case TrackingState::initialized: return "initialized";
    case TrackingState::tracked: return "tracked";
    case TrackingState::doubtful: return "doubtful";
    case TrackingState::predicted: return "predicted";
    case TrackingState::not_started: return "not started";
  }
  return "unknown";
}

const char* toString(OdometryEngine engine)
{
  switch (engine) {
    case OdometryEngine::features: return "features";
    case OdometryEngine::surfaces: return "surfaces";
  }
  return "unknown";
}

const char* toString(CompensationMode mode)
{
  switch (mode) {
    case CompensationMode::none: return "none";
    case CompensationMode::two_stage: return "two-stage";
    case CompensationMode::iterative: return "loam";
    case CompensationMode::continuous: return "continuous";
  }
  return "unknown";
}

void validate(const OdometryParameters& p)
{
  const ParameterCheck check("odometry");
  check.range("vertical_correction", p.vertical_correction, -10.0, 10.0);
  check.atLeast("scan_period", p.scan_period, 0.0);
  check.range("threads", p.threads, 0, 1024);
  check.range("start_effort", p.start_effort, 2, 1000);
  check.atLeast("keyframe translation", p.keyframe.translation, 0.0);
  if (!p.sensor.has_scan_lines && p.engine == OdometryEngine::features) {
    throw std::invalid_argument("odometry: the sensor has no scan lines, which the engine 'features' needs");
  }
  validate(p.features);
  validate(p.map);
}

struct OdometryPipeline::Impl {
  using Engine = std::variant<FeatureOdometry, SurfaceOdometry>;

  Impl(const OdometryParameters& p, const OdometryComponents& c, SensorFrame f = SensorFrame())
      : frame(std::move(f)),
        engine(p.engine == OdometryEngine::surfaces ? Engine(SurfaceOdometry(p, c)) : Engine(FeatureOdometry(p, c)))
  {
  }

  /// What both have: `visit([](auto& odometry) ...)`.
  template <typename Visitor>
  decltype(auto) visit(Visitor visitor)
  {
    return std::visit(visitor, engine);
  }

  /// What both have in common.
  [[nodiscard]] OdometryRun& of()
  {
    return visit([](auto& odometry) -> OdometryRun& { return odometry; });
  }

  /// Anew, at a pose of the frame.
  [[nodiscard]] std::unique_ptr<Impl> again(const OdometryComponents& c, SensorFrame f, const SE3& world_T_frame)
  {
    auto other = std::make_unique<Impl>(OdometryParameters(of().parameters), OdometryComponents(c), std::move(f));
    other->of().initial_pose = other->of().report.world_T_sensor = other->frame.ofSensor(world_T_frame);
    other->frame.tell(other->of().report);
    return other;
  }

  const OdometryReport& track(const CloudView& scan, std::optional<double> stamp)
  {
    if (repetition.isLastAgain(scan, stamp)) {
      of().repeatScan();
    } else {
      visit([&](auto& odometry) { odometry.track(frame.ofSensor(scan), stamp); });
    }
    return noteReport();
  }

  const OdometryReport& miss(std::optional<double> stamp)
  {
    visit([&](auto& odometry) {
      odometry.beginScan(0, stamp);
      odometry.predictOnly("the scan is missing");
    });
    return noteReport();
  }

  SensorFrame frame;
  ScanRepetition repetition;

private:
  const OdometryReport& noteReport()
  {
    OdometryReport& report = of().report;
    report.engine =
        std::holds_alternative<SurfaceOdometry>(engine) ? OdometryEngine::surfaces : OdometryEngine::features;
    frame.tell(report);
    return frame.report(report);
  }

  Engine engine;
};

OdometryPipeline::OdometryPipeline(const OdometryParameters& parameters)
{
  validate(parameters);
  OdometryParameters resolved = parameters;
  resolved.threads = threadCount(static_cast<unsigned int>(parameters.threads));
  impl_ = std::make_unique<Impl>(resolved, OdometryComponents());
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
  return impl_->miss(stamp);
}

void OdometryPipeline::setMotionHint(const MotionHint& hint)
{
  hint.validate();
  impl_->of().hint.give(impl_->frame.ofSensor(hint));
}

void OdometryPipeline::setPose(const SE3& world_T_sensor)
{
  if (!world_T_sensor.isFinite()) {
    throw std::invalid_argument("the pose that is set is not finite");
  }
  impl_->repetition = ScanRepetition();  // the last scan again is then one at that pose
  impl_->visit([&](auto& odometry) { odometry.setPose(impl_->frame.ofSensor(world_T_sensor)); });
}

const OdometryReport& OdometryPipeline::report() const
{
  return impl_->frame.report(impl_->of().report);
}

SE3 OdometryPipeline::getPose() const
{
  return report().world_T_sensor;
}

const KeyframeVoxelMap& OdometryPipeline::map() const
{
  return impl_->of().map_building.map();
}

const OdometryParameters& OdometryPipeline::getParameters() const
{
  return impl_->of().parameters;
}

void OdometryPipeline::localizeIn(KeyframeVoxelMap map, const SE3& world_T_sensor, MapUse use)
{
  if (map.empty()) {
    throw std::invalid_argument("the map to localise in is empty");
  }
  reset(world_T_sensor);
  impl_->visit([&](auto& odometry) { odometry.localizeIn(std::move(map), use); });
}

void OdometryPipeline::reset(const SE3& world_T_sensor)
{
  if (!world_T_sensor.isFinite()) {
    throw std::invalid_argument("the pose to begin with is not finite");
  }
  impl_ = impl_->again(getComponents(), impl_->frame, world_T_sensor);
}

void OdometryPipeline::setComponents(const OdometryComponents& components)
{
  const auto isNull = [](const PoseFactor::ConstPtr& factor) { return factor == nullptr; };
  if (std::any_of(components.factors.begin(), components.factors.end(), isNull)) {
    throw std::invalid_argument("odometry: a factor is null");
  }
  if (getParameters().engine == OdometryEngine::features && (components.map || components.select_points)) {
    throw std::invalid_argument("odometry: the engine 'features' registers features with its own map");
  }
  impl_ = impl_->again(components, impl_->frame, SE3());
}

void OdometryPipeline::setSensorPose(const SE3& frame_T_sensor)
{
  if (!frame_T_sensor.isFinite()) {
    throw std::invalid_argument("the sensor's pose is not finite");
  }
  const DegreesOfFreedom& locked = getParameters().registration.locked;
  const bool any = std::any_of(locked.begin(), locked.end(), [](bool is_locked) { return is_locked; });
  if (any && rotationAngle(frame_T_sensor.rotation) > 0.0) {
    throw std::invalid_argument("locked degrees of freedom are the sensor's: its axes must be those of the frame");
  }
  impl_ = impl_->again(getComponents(), SensorFrame(frame_T_sensor), SE3());
}

const SE3& OdometryPipeline::getSensorPose() const
{
  return impl_->frame.pose();
}

const OdometryComponents& OdometryPipeline::getComponents() const
{
  return impl_->of().components;
}

}  // namespace pcl_floam
