#include <pcl_floam/evaluation/trajectory_metrics.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace pcl_floam {

namespace {

constexpr double kDegreesPerRad = 57.295779513082320876798;

/// Development kit of KITTI: a sub-sequence starts at every tenth pose.
constexpr std::size_t kKittiStep = 10;
/// m; shorter paths have room for a handful of 100 m sub-sequences only.
constexpr double kShortestKittiPath = 200.0;

void requireSameSize(const std::vector<SE3>& estimate, const std::vector<SE3>& truth)
{
  if (estimate.size() != truth.size()) {
    throw std::invalid_argument("the estimate has " + std::to_string(estimate.size()) + " poses, the ground truth " +
                                std::to_string(truth.size()));
  }
}

ErrorStatistics statisticsOf(std::vector<double> errors)
{
  ErrorStatistics statistics;
  statistics.count = errors.size();
  if (errors.empty()) {
    return statistics;
  }
  const auto n = static_cast<double>(errors.size());
  std::sort(errors.begin(), errors.end());
  statistics.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
  statistics.rms = std::sqrt(std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) / n);
  const std::size_t middle = errors.size() / 2;
  statistics.median = errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  statistics.max = errors.back();
  return statistics;
}

/// What is left of the true motion between two poses once the estimated one is taken off.
SE3 relativeError(const std::vector<SE3>& estimate, const std::vector<SE3>& truth, std::size_t first, std::size_t last)
{
  const SE3 estimated_motion = estimate[first].inverse() * estimate[last];
  const SE3 true_motion = truth[first].inverse() * truth[last];
  return estimated_motion.inverse() * true_motion;
}

/// Mean over the sub-sequences of one length, as fractions and rad per m; not yet in percent and degrees.
SegmentErrors errorsOfLength(const std::vector<SE3>& estimate, const std::vector<SE3>& truth,
                             const std::vector<double>& distance, double length, std::size_t step)
{
  SegmentErrors errors;
  errors.length = length;
  for (std::size_t first = 0; first < truth.size(); first += step) {
    const auto end = std::upper_bound(distance.begin() + static_cast<std::ptrdiff_t>(first), distance.end(),
                                      distance[first] + length);
    if (end == distance.end()) {
      break;
    }
    const SE3 error = relativeError(estimate, truth, first, static_cast<std::size_t>(end - distance.begin()));
    errors.translation += error.translation.norm() / length;
    errors.rotation += rotationAngle(error.rotation) / length;
    ++errors.segments;
  }
  return errors;
}

/// Sums become means, in percent and degrees per 100 m.
template <typename Errors>
void finish(Errors& errors)
{
  if (errors.segments > 0) {
    const double scale = 100.0 / static_cast<double>(errors.segments);
    errors.translation *= scale;
    errors.rotation *= scale * kDegreesPerRad;
  }
}

Eigen::Vector3d meanPosition(const std::vector<SE3>& trajectory)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SE3& pose : trajectory) {
    sum += pose.translation;
  }
  return sum / static_cast<double>(trajectory.size());
}

}  // namespace

std::vector<double> kittiLengths()
{
  return {100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0};
}

std::vector<double> lengthsFor(double path_length)
{
  if (path_length >= kShortestKittiPath || !(path_length > 0.0)) {
    return kittiLengths();
  }
  const double tenth = path_length / 10.0;
  const double power = std::pow(10.0, std::floor(std::log10(tenth)));
  double unit = power;
  for (const double factor : {2.0, 5.0}) {
    unit = factor * power <= tenth ? factor * power : unit;
  }
  std::vector<double> lengths(8);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] = static_cast<double>(i + 1) * unit;
  }
  return lengths;
}

KittiMetric kittiMetric(const std::vector<SE3>& estimate, const std::vector<SE3>& truth,
                        const std::vector<double>& lengths, std::size_t step)
{
  requireSameSize(estimate, truth);
  if (step == 0 || std::any_of(lengths.begin(), lengths.end(), [](double length) { return !(length > 0.0); })) {
    throw std::invalid_argument("lengths and step of the KITTI metric must be greater than 0");
  }
  std::vector<double> distance(truth.size(), 0.0);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    distance[i] = distance[i - 1] + (truth[i].translation - truth[i - 1].translation).norm();
  }
  KittiMetric metric;
  metric.standard_lengths = lengths == kittiLengths() && step == kKittiStep;
  metric.step = step;
  for (const double length : lengths) {
    SegmentErrors errors = errorsOfLength(estimate, truth, distance, length, step);
    if (errors.segments > 0) {
      metric.translation += errors.translation;
      metric.rotation += errors.rotation;
      metric.segments += errors.segments;
      finish(errors);
      metric.lengths.push_back(errors);
    }
  }
  finish(metric);
  return metric;
}

KittiMetric fittingKittiMetric(const std::vector<SE3>& estimate, const std::vector<SE3>& truth)
{
  const std::vector<double> lengths = lengthsFor(pathLength(truth));
  return kittiMetric(estimate, truth, lengths, lengths == kittiLengths() ? kKittiStep : 1);
}

SE3 alignTrajectories(const std::vector<SE3>& estimate, const std::vector<SE3>& truth)
{
  requireSameSize(estimate, truth);
  if (truth.empty()) {
    return {};
  }
  const Eigen::Vector3d estimate_mean = meanPosition(estimate);
  const Eigen::Vector3d truth_mean = meanPosition(truth);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    covariance += (truth[i].translation - truth_mean) * (estimate[i].translation - estimate_mean).transpose();
  }
  const Eigen::Matrix3d rotation = nearestRotation(covariance);
  return {rotation, truth_mean - rotation * estimate_mean};
}

ErrorStatistics absoluteTrajectoryError(const std::vector<SE3>& estimate, const std::vector<SE3>& truth, bool align)
{
  requireSameSize(estimate, truth);
  if (truth.empty()) {
    return {};
  }
  const SE3 truth_T_estimate = align ? alignTrajectories(estimate, truth) : truth.front() * estimate.front().inverse();
  std::vector<double> errors(truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    errors[i] = (truth_T_estimate * estimate[i].translation - truth[i].translation).norm();
  }
  return statisticsOf(std::move(errors));
}

RelativePoseError relativePoseError(const std::vector<SE3>& estimate, const std::vector<SE3>& truth, std::size_t step)
{
  requireSameSize(estimate, truth);
  if (step == 0) {
    throw std::invalid_argument("the step of the relative pose error must be greater than 0");
  }
  std::vector<double> translation;
  std::vector<double> rotation;
  for (std::size_t i = 0; i + step < truth.size(); ++i) {
    const SE3 error = relativeError(estimate, truth, i, i + step);
    translation.push_back(error.translation.norm());
    rotation.push_back(rotationAngle(error.rotation) * kDegreesPerRad);
  }
  return {statisticsOf(std::move(translation)), statisticsOf(std::move(rotation))};
}

RestMetric restMetric(const std::vector<SE3>& trajectory)
{
  RestMetric metric;
  for (const SE3& pose : trajectory) {
    const SE3 from_first = trajectory.front().inverse() * pose;
    metric.drift = from_first.translation.norm();
    metric.wander = std::max(metric.wander, metric.drift);
    metric.rotation_drift = rotationAngle(from_first.rotation) * kDegreesPerRad;
    metric.rotation_wander = std::max(metric.rotation_wander, metric.rotation_drift);
  }
  metric.jitter = relativePoseError(trajectory, std::vector<SE3>(trajectory.size()));
  return metric;
}

double pathLength(const std::vector<SE3>& trajectory)
{
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].translation - trajectory[i - 1].translation).norm();
  }
  return length;
}

}  // namespace pcl_floam
