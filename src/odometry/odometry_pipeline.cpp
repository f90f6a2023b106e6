#include "common/parameter_check.h"
#include "odometry/constant_velocity.h"
#include "odometry/stopwatch.h"
#include "odometry/vertical_correction.h"

#include <pcl_floam/filters/feature_extractor.h>
#include <pcl_floam/filters/sweep_motion.h>
#include <pcl_floam/odometry/odometry.h>
#include <pcl_floam/registration/feature_registration.h>

#include <algorithm>
#include <cmath>

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

namespace {

/// The instant of the sweep, as a fraction of it, at which the pipeline sees points and estimates poses.
///
/// At the middle an error of the assumed motion moves the sweep's two halves apart but not its pose; at the end it
/// moves the pose by half of it, which the next motion then takes up with the opposite sign. Measured, end against
/// middle: handheld VLP-16 4.8 against 3.2 cm, urban HDL-64 0.30 against 0.17 %, and LOAM's compensation oscillates.
constexpr double kReference = 0.5;

/// Root mean square distance of the features: what a rotation error is multiplied with.
double typicalRange(const FeatureSet& features)
{
  double sum = 0.0;
  for (const Feature& f : features.planes) {
    sum += static_cast<double>(f.x) * f.x + static_cast<double>(f.y) * f.y + static_cast<double>(f.z) * f.z;
  }
  return features.planes.empty() ? 1.0 : std::sqrt(sum / static_cast<double>(features.planes.size()));
}

/// About two thousand of the features, evenly taken.
FeatureSet sampleOf(const FeatureSet& features)
{
  constexpr std::size_t kWanted = 1000;  // of each kind
  FeatureSet sample;
  const auto take = [](const std::vector<Feature>& from, std::vector<Feature>& to) {
    for (std::size_t i = 0; i < from.size(); i += 1 + from.size() / kWanted) {
      to.push_back(from[i]);
    }
  };
  take(features.edges, sample.edges);
  take(features.planes, sample.planes);
  return sample;
}

}  // namespace

/// Within the pipeline, every pose is the sensor's at \ref kReference of its sweep. Other instants are derived when
/// poses are given out.
struct OdometryPipeline::Impl {
  explicit Impl(const OdometryParameters& p) : parameters(p), map(p.map), clock(p.scan_period) {}

  OdometryParameters parameters;
  KeyframeVoxelMap map;
  ScanClock clock;
  ConstantVelocity velocity;
  PredictionError prediction_error;
  SE3 initial_pose;      ///< of the first scan, at the instant of the parameters
  SE3 world_T_last;      ///< last scan, tracked or predicted
  SE3 world_T_tracked;   ///< last tracked scan
  SE3 world_T_keyframe;  ///< last keyframe
  double periods = 1.0;  ///< from the last scan to this one
  double periods_since_tracked = 0.0;
  double sweep_fraction = 1.0;  ///< duration of the sweep in periods
  bool started = false;
  int failed_starts = 0;

  ScanLines lines;
  ScanTiming timing;
  FeatureSet measured;     ///< E_k and S_k as measured
  FeatureSet undistorted;  ///< compensated to the reference instant
  FeatureSet first;        ///< the first scan as measured, until its motion is known
  SE3 world_T_predicted;
  OdometryReport report;
  Stopwatch watch;

  const OdometryReport& track(const CloudView& scan, std::optional<double> stamp)
  {
    beginScan(scan.size, stamp);
    extractFeatures(scan);
    if (!hasEnoughFeatures()) {
      return predictOnly(lines.valid() ? "too few features" : toString(lines.failure));
    }
    if (!started) {
      return start();
    }
    predictMotion();
    estimatePose();
    if (!report.registration.hasConverged()) {
      return velocity.isKnown() ? predictOnly(toString(report.registration.termination)) : startAgain();
    }
    updateMap();
    return finish(TrackingState::tracked);
  }

  void beginScan(std::size_t points, std::optional<double> stamp)
  {
    report = OdometryReport();
    report.points = points;
    watch.start();
    periods = clock.tick(stamp);
    if (started) {
      periods_since_tracked += periods;
    }
  }

  // Sensor Model and Feature Extraction
  void extractFeatures(const CloudView& scan)
  {
    findScanLines(scan, parameters.sensor, parameters.scan_line_source, lines);
    timing = findScanTiming(scan, lines, parameters.timing_source, parameters.rotation);
    sweep_fraction = 1.0;
    if (timing.duration > 0.0 && clock.period() > 0.0) {
      sweep_fraction = std::min(1.0, timing.duration / clock.period());
    }
    report.milliseconds.scan_lines = watch.lap();

    pcl_floam::extractFeatures(scan, lines, timing, parameters.features, measured);
    correctVerticalAngle(parameters.vertical_correction, measured);
    report.milliseconds.features = watch.lap();

    report.scan_line_source = lines.source;
    report.scan_line_confidence = lines.confidence;
    report.scan_lines = lines.lines();
    report.timing_source = timing.source;
    report.edges = measured.edges.size();
    report.planes = measured.planes.size();
  }

  [[nodiscard]] bool hasEnoughFeatures() const
  {
    return static_cast<int>(measured.edges.size() + measured.planes.size()) >=
           parameters.registration.min_correspondences;
  }

  // Motion Estimation (Eq. 2)
  void predictMotion() { world_T_predicted = world_T_last * velocity.motion(periods); }

  // Distortion Compensation, both stages (Eq. 3, 4 with the predicted motion, Eq. 12 with the optimised one)
  void compensate(const FeatureSet& features, const Vector6& twist_per_period, FeatureSet& result)
  {
    const bool moving = parameters.compensation != CompensationMode::none && timing.valid();
    const Vector6 twist = moving ? Vector6(sweep_fraction * twist_per_period) : Vector6(Vector6::Zero());
    pcl_floam::compensate(features, SweepMotion(twist, kReference), result);
  }

  // Pose Estimation (Eq. 5 to 14)
  void estimatePose()
  {
    if (!velocity.isKnown()) {
      estimateFirstMotion();
      return;
    }
    compensate(measured, velocity.twist(), undistorted);
    report.milliseconds.compensation += watch.lap();
    report.registration = registerScan(world_T_predicted, prediction_error.bound(periods_since_tracked));
    report.milliseconds.registration += watch.lap();
  }

  RegistrationReport registerScan(const SE3& guess, double guess_uncertainty)
  {
    RegistrationRun run;
    run.guess = guess;
    run.guess_uncertainty = guess_uncertainty;
    run.threads = parameters.threads;
    // Not before the first motion is known: the map is then distorted as the scan is, and must stay so.
    if (parameters.compensation == CompensationMode::iterative && velocity.isKnown()) {
      run.recompensate = [this](const SE3& world_T_sensor, FeatureSet& source) {
        compensate(measured, twistTo(world_T_sensor), source);
      };
      const bool held = timing.valid() && periods_since_tracked > 0.0;
      run.reference = kReference;
      run.response_slope = held ? sweep_fraction / periods_since_tracked : 0.0;
    }
    const FeatureTarget target{&map.search(FeatureKind::edge), &map.search(FeatureKind::plane)};
    return registerFeatures(undistorted, target, run, parameters.registration);
  }

  /// Motion per period from the last tracked scan to a pose (Eq. 12a).
  [[nodiscard]] Vector6 twistTo(const SE3& world_T_sensor) const
  {
    if (periods_since_tracked <= 0.0) {
      return velocity.twist();
    }
    return log(world_T_tracked.inverse() * world_T_sensor) / periods_since_tracked;
  }

  /// The second scan: neither its motion nor the first one's is known, so that the map, too, is distorted. Both are
  /// compensated and registered in turn until they agree; from then on prediction is possible.
  void estimateFirstMotion()
  {
    constexpr int kMaxRounds = 8;
    constexpr double kFarthestStart = 4.0;  // m: 144 km/h at 10 Hz
    double uncertainty = kFarthestStart;
    Vector6 twist = Vector6::Zero();
    for (int round = 0; round < kMaxRounds; ++round) {
      placeFirstScan(twist);
      // The wide search of the first round is costly, and a part of the features does for a rough estimate.
      compensate(round == 0 ? sampleOf(measured) : measured, twist, undistorted);
      report.milliseconds.compensation += watch.lap();
      report.registration = registerScan(world_T_tracked * exp(periods_since_tracked * twist), uncertainty);
      report.milliseconds.registration += watch.lap();
      if (!report.registration.hasConverged()) {
        return;
      }
      const Vector6 estimate = twistTo(report.registration.target_T_source);
      const double change = (estimate - twist).norm();
      twist = estimate;
      uncertainty = 0.0;
      if (round > 0 && (change < 1e-3 || parameters.compensation == CompensationMode::none)) {
        break;
      }
    }
    world_T_predicted = report.registration.target_T_source;
  }

  /// (Re)builds the map from the first scan, given its motion. Its pose at the instant of the parameters stays what it
  /// was reported to be.
  void placeFirstScan(const Vector6& twist)
  {
    map.clear();
    FeatureSet compensated;
    compensate(first, twist, compensated);
    world_T_tracked = initial_pose * instantToReference(twist);
    world_T_keyframe = world_T_tracked;
    map.insert(compensated, world_T_tracked);
  }

  /// Motion from the instant of the parameters to the reference instant.
  [[nodiscard]] SE3 instantToReference(const Vector6& twist) const
  {
    // Without compensation a scan has no instants: its one pose is that of the scan as it stands.
    const bool instants = parameters.compensation != CompensationMode::none;
    return instants ? exp((kReference - fractionOf(parameters.pose_instant)) * sweep_fraction * twist) : SE3();
  }

  // Mapping Building & Distortion Compensation Update (Eq. 12)
  void updateMap()
  {
    const SE3& optimized = report.registration.target_T_source;
    prediction_error.observe(world_T_predicted.inverse() * optimized, typicalRange(undistorted));
    if (periods_since_tracked > 0.0) {
      velocity.set(twistTo(optimized));
    }
    world_T_last = world_T_tracked = optimized;
    periods_since_tracked = 0.0;
    report.keyframe = parameters.keyframe.isKeyframe(world_T_keyframe, optimized);
    if (report.keyframe) {
      compensate(measured, velocity.twist(), undistorted);
      report.milliseconds.compensation += watch.lap();
      map.insert(undistorted, optimized);
      world_T_keyframe = optimized;
    }
    report.milliseconds.map += watch.lap();
  }

  /// The first usable scan.
  const OdometryReport& start()
  {
    started = true;
    first = measured;
    placeFirstScan(Vector6::Zero());
    world_T_last = world_T_tracked;
    periods_since_tracked = 0.0;
    report.keyframe = true;
    report.milliseconds.map += watch.lap();
    return finish(TrackingState::initialized);
  }

  /// A scan that could not be registered with the first one. A bad first scan must not hold up the rest for ever.
  const OdometryReport& startAgain()
  {
    constexpr int kMaxFailures = 5;
    const char* reason = toString(report.registration.termination);
    if (++failed_starts < kMaxFailures) {
      return predictOnly(reason);
    }
    failed_starts = 0;
    start();
    report.reason = std::string("started again, since the first scan was never matched: ") + reason;
    return report;
  }

  const OdometryReport& predictOnly(const char* reason)
  {
    report.reason = reason;
    if (!started) {
      return finish(TrackingState::not_started);
    }
    world_T_last = world_T_last * velocity.motion(periods);
    return finish(TrackingState::predicted);
  }

  const OdometryReport& finish(TrackingState state)
  {
    report.state = state;
    report.world_T_sensor = started ? world_T_last * instantToReference(velocity.twist()).inverse() : initial_pose;
    report.milliseconds.total = watch.total();
    return report;
  }
};

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
  return impl_->predictOnly("the scan is missing");
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

void OdometryPipeline::reset(const SE3& world_T_sensor)
{
  const OdometryParameters parameters = impl_->parameters;
  impl_ = std::make_unique<Impl>(parameters);
  impl_->initial_pose = world_T_sensor;
  impl_->report.world_T_sensor = world_T_sensor;
}

}  // namespace pcl_floam
