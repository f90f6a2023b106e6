// Whether the sensor stands still: noise about one pose does, at any scale, and nothing that moves.
#include "common/pi.h"
#include "motion/rest.h"

#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace pcl_floam {
namespace {

constexpr int kScans = 100;
constexpr double kNoise = 0.002;  // m and rad, to either side

using Path = std::function<SE3(int)>;

SE3 standing(int /*scan*/)
{
  return exp((Vector6() << 3.0, -2.0, 1.0, 0.1, -0.2, 2.0).finished());
}

SE3 noisy(const SE3& pose, std::mt19937& random, double noise)
{
  const Eigen::Vector3d off = test::randomVector(random, noise);
  return {pose.rotation * expSO3(test::randomVector(random, noise)), pose.translation + off};
}

/// What a registration would tell of that noise, which has a third of its square along each axis.
Matrix6 covarianceOf(double noise)
{
  return noise * noise / 3.0 * Matrix6::Identity();
}

/// Scans after which a path was called rest.
int scansAtRest(const Path& path, double noise, std::uint32_t seed)
{
  std::mt19937 random(seed);
  Rest rest;
  int count = 0;
  for (int scan = 0; scan < kScans; ++scan) {
    rest.take(noisy(path(scan), random, noise), covarianceOf(noise));
    count += rest.isAtRest() ? 1 : 0;
  }
  return count;
}

TEST(Rest, StandsWhereItsPosesAreInTheMean)
{
  for (const double noise : {1e-5, kNoise, 1.0}) {  // whatever the unit
    std::mt19937 random(7);
    Rest rest;
    for (int scan = 0; scan < kScans; ++scan) {
      rest.take(noisy(standing(scan), random, noise), covarianceOf(noise));
    }
    ASSERT_TRUE(rest.isAtRest()) << noise;
    EXPECT_EQ(rest.poses(), kScans);
    const SE3 off = standing(0).inverse() * rest.pose();
    EXPECT_LT(off.translation.norm(), 0.25 * noise);
    EXPECT_LT(rotationAngle(off.rotation), 0.25 * noise);
  }
}

TEST(Rest, PosesThatAreAllAlikeAreAtRest)
{
  EXPECT_GT(scansAtRest(standing, 0.0, 0), 85);
}

TEST(Rest, IsFoundAfterTheSensorHasBraked)
{
  constexpr int kStops = 30;
  for (const double speed : {5.0, 50.0, 500.0}) {  // noises a scan, at first
    const Path braking = [speed](int scan) {
      const double left = std::max(0, kStops - scan);
      return SE3(Eigen::Matrix3d::Identity(), {-0.5 * speed * kNoise * left * left / kStops, 0.0, 0.0});
    };
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      EXPECT_GT(scansAtRest(braking, kNoise, seed), 20) << speed << ' ' << seed;
    }
  }
}

TEST(Rest, IsFoundSoonWhateverTheNoise)
{
  int found = 0;
  constexpr int kSeeds = 50;
  for (int seed = 0; seed < kSeeds; ++seed) {
    found += scansAtRest(standing, kNoise, static_cast<std::uint32_t>(seed));
  }
  EXPECT_GT(found, 0.8 * kSeeds * kScans);
}

TEST(Rest, NothingThatMovesStandsStill)
{
  const auto line = [](int scan) { return SE3(Eigen::Matrix3d::Identity(), {3.0 * kNoise * scan, 0.0, 0.0}); };
  const auto from_rest = [](int scan) { return SE3(Eigen::Matrix3d::Identity(), {kNoise * scan * scan, 0.0, 0.0}); };
  const auto turn = [](int scan) { return SE3(expSO3({0.0, 0.0, 3.0 * kNoise * scan}), Eigen::Vector3d::Zero()); };
  const auto to_and_fro = [](int scan) {
    return SE3(Eigen::Matrix3d::Identity(), {0.0, 10.0 * kNoise * std::sin(0.6 * scan), 0.0});
  };
  const auto jump = [](int scan) {  // and a steady motion that is lost in the noise of the jump
    return SE3(Eigen::Matrix3d::Identity(), {scan > 0 ? 1.0 + 3.0 * kNoise * scan : 0.0, 0.0, 0.0});
  };
  for (const Path& path : std::vector<Path>{line, from_rest, turn, to_and_fro, jump}) {
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
      EXPECT_EQ(scansAtRest(path, kNoise, seed), 0) << seed;
    }
  }
}

/// Along one direction, where noise is felt most, and among few poses, which tell little of it.
TEST(Rest, NoiseHardlyEverEndsIt)
{
  constexpr int kRuns = 10000;
  constexpr int kFew = 20;
  constexpr double kChance = 1.0 / 36000.0;
  constexpr double kTold = 10.0 * kNoise;  // that alone ends nothing
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, kNoise);
  int ended = 0;
  for (int run = 0; run < kRuns; ++run) {
    Rest rest;
    rest.take(standing(0), covarianceOf(kTold));
    for (int scan = 1; scan < kFew; ++scan) {
      rest.take({standing(0).rotation, standing(0).translation + normal(random) * Eigen::Vector3d::UnitX()},
                covarianceOf(kTold));
      ended += rest.poses() == 1 ? 1 : 0;
    }
  }
  EXPECT_LT(ended, 3.0 * kChance * kRuns * kFew);
}

TEST(Rest, AnOutlierDoesNotHideTheMotionAfterIt)
{
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    Rest rest;
    for (int scan = 0; scan < kScans; ++scan) {
      const double way = scan == 5 ? 100.0 : std::max(0, scan - 15) * 5.0;  // noises
      const SE3 pose = standing(0) * SE3(Eigen::Matrix3d::Identity(), {way * kNoise, 0.0, 0.0});
      rest.take(noisy(pose, random, kNoise), covarianceOf(kNoise));
      EXPECT_FALSE(rest.isAtRest() && scan > 15) << seed << ' ' << scan;
    }
  }
}

/// Each swing undoes the one before, as noise does, but is more than a registration may be off.
TEST(Rest, WhatShakesDoesNotStandStill)
{
  for (const double hertz : {2.7, 3.5, 4.3, 5.0, 6.0, 7.3}) {
    for (const double swing : {20.0, 500.0}) {  // noises
      const auto shaken = [&](int scan) { return swing * kNoise * std::sin(0.2 * kPi * hertz * scan + 1.0); };
      const auto shifted = [&](int scan) { return SE3(Eigen::Matrix3d::Identity(), {0.0, shaken(scan), 0.0}); };
      const auto turned = [&](int scan) { return SE3(expSO3({shaken(scan), 0.0, 0.0}), Eigen::Vector3d::Zero()); };
      EXPECT_EQ(scansAtRest(shifted, kNoise, 5), 0) << hertz << ' ' << swing;
      EXPECT_EQ(scansAtRest(turned, kNoise, 6), 0) << hertz << ' ' << swing;
    }
  }
}

TEST(Rest, EndsAsSoonAsAPoseIsFarOff)
{
  std::mt19937 random(3);
  Rest rest;
  for (int scan = 0; scan < kScans; ++scan) {
    rest.take(noisy(standing(scan), random, kNoise), covarianceOf(kNoise));
  }
  ASSERT_TRUE(rest.isAtRest());
  const SE3 moved = standing(0) * exp((Vector6() << 10.0 * kNoise, 0.0, 0.0, 0.0, 0.0, 0.0).finished());
  rest.take(moved, covarianceOf(kNoise));
  EXPECT_FALSE(rest.isAtRest());
  EXPECT_EQ(rest.poses(), 1);
  EXPECT_EQ(rest.pose().translation, moved.translation);
}

}  // namespace
}  // namespace pcl_floam
