#include "odometry/relocalization.h"

#include "odometry/best_fit.h"
#include "registration/feature_sampling.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_floam {

namespace {

/// The prediction, then both poses turned about the sensor's upright axis.
std::vector<SE3> guessesFor(const SE3& predicted, const SE3& tracked)
{
  constexpr int kTurns = 18;
  constexpr double kApart = 1.0;  // m; nearer than that a registration from one finds the other
  std::vector<SE3> guesses = {predicted};
  std::vector<SE3> places = {tracked};
  if ((predicted.translation - tracked.translation).norm() > kApart) {
    places.push_back(predicted);
  }
  for (const SE3& place : places) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const double angle = 2.0 * M_PI * turn / kTurns;
      SE3 turned = place;
      turned.rotation = place.rotation * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      guesses.push_back(turned);
    }
  }
  return guesses;
}

}  // namespace

SE3 relocalize(const FeatureSet& scan, const FeatureTarget& target, RegistrationRun run,
               const RegistrationParameters& parameters, const SE3& world_T_tracked)
{
  constexpr int kRoughIterations = 10;
  constexpr double kReach = 1.0;  // m
  // In simulated worlds wrong guesses leave residuals ten times as large and more, also where a corridor looks the same
  // from the other side.
  constexpr double kClearlyBetter = 0.5;
  RegistrationParameters rough = parameters;
  rough.max_iterations = std::min(rough.max_iterations, kRoughIterations);
  run.guess_uncertainty = kReach;
  const FeatureSet sample = spreadSample(scan);
  std::vector<RegistrationReport> tried;
  for (const SE3& guess : guessesFor(run.guess, world_T_tracked)) {
    run.guess = run.sweep.prior.pose = guess;
    tried.push_back(registerFeatures(sample, target, run, rough));
  }
  return tried[bestFit(tried, kClearlyBetter)].target_T_source;
}

}  // namespace pcl_floam
