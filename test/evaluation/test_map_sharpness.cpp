#include "support/constants.h"
#include "support/random_motion.h"
#include "support/room_scans.h"

#include <pcl_floam/evaluation/map_sharpness.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_floam {
namespace {

using test::kNan;
using test::kPi;
using test::randomTwist;
using test::uniform;

using Scan = std::vector<Eigen::Vector3f>;

struct Drive {
  std::vector<Scan> scans;
  std::vector<SE3> poses;
};

void expectEqual(const MapSharpness& a, const MapSharpness& b)
{
  EXPECT_EQ(a.mean_map_entropy, b.mean_map_entropy);
  EXPECT_EQ(a.mean_plane_variance, b.mean_plane_variance);
  EXPECT_EQ(a.points, b.points);
}

/// A furnished room as seen on a way through it, the sensor turned another way at each place.
Drive driveThroughARoom()
{
  Drive drive;
  std::mt19937 random(5);
  for (int i = 0; i < 6; ++i) {
    const double x = 0.3 * i;
    const std::string bytes = test::roomScan(x, 0.0);
    const SE3 sensor_T_level(expSO3(test::randomVector(random, 1.0)), Eigen::Vector3d::Zero());
    Scan scan;
    for (std::size_t byte = 0; byte < bytes.size(); byte += 16) {
      Eigen::Vector3f point;
      std::memcpy(point.data(), &bytes[byte], 12);
      scan.emplace_back((sensor_T_level.rotation * point.cast<double>()).cast<float>());
    }
    drive.scans.push_back(scan);
    drive.poses.push_back(SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, 0.0, 0.0)) * sensor_T_level.inverse());
  }
  return drive;
}

/// Scans of a level square from 2 m above, all from one place: \p points each, at random, with noise upwards and
/// downwards.
/// \param x m, of the square's middle \param side m \param sigma m, standard deviation of the noise
Drive squareFromAbove(std::size_t scans, std::size_t points, double side, double sigma, double x = 0.0)
{
  Drive drive;
  std::mt19937 random(6);
  drive.poses.resize(scans);
  drive.scans.resize(scans);
  for (Scan& scan : drive.scans) {
    for (std::size_t i = 0; i < points; ++i) {
      const double height = uniform(random, std::sqrt(3.0) * sigma) - 2.0;
      scan.emplace_back(
          Eigen::Vector3d(x + uniform(random, 0.5 * side), uniform(random, 0.5 * side), height).cast<float>());
    }
  }
  return drive;
}

void append(Drive& drive, const Drive& more)
{
  drive.scans.insert(drive.scans.end(), more.scans.begin(), more.scans.end());
  drive.poses.insert(drive.poses.end(), more.poses.begin(), more.poses.end());
}

/// Of a disc of that radius with noise across.
double entropyOfDisc(double radius, double sigma)
{
  const double along = radius * radius / 4.0;
  return 0.5 * std::log(std::pow(2.0 * kPi * std::exp(1.0), 3.0) * along * along * sigma * sigma);
}

TEST(MapSharpness, TheMoreThePosesAreDisturbedTheLessSharpIsTheMap)
{
  const Drive drive = driveThroughARoom();
  MapSharpness last = mapSharpness(drive.scans, drive.poses);
  ASSERT_GT(last.points, 5000U);
  for (const double disturbance : {0.01, 0.03, 0.1}) {
    std::mt19937 random(7);
    std::vector<SE3> poses = drive.poses;
    for (SE3& pose : poses) {
      pose = pose * exp(randomTwist(random, disturbance, 0.1 * disturbance));
    }
    const MapSharpness now = mapSharpness(drive.scans, poses);
    EXPECT_GT(now.mean_map_entropy, last.mean_map_entropy + 0.05) << disturbance;
    EXPECT_GT(now.mean_plane_variance, 1.05 * last.mean_plane_variance) << disturbance;
    last = now;
  }
}

TEST(MapSharpness, NothingDependsOnTheFrameOfThePoses)
{
  const Drive drive = driveThroughARoom();
  const MapSharpness here = mapSharpness(drive.scans, drive.poses);
  std::mt19937 random(8);
  const SE3 motion = exp(randomTwist(random, 2000.0, 2.0));
  std::vector<SE3> poses = drive.poses;
  for (SE3& pose : poses) {
    pose = motion * pose;
  }
  const MapSharpness there = mapSharpness(drive.scans, poses);
  EXPECT_NEAR(there.mean_map_entropy, here.mean_map_entropy, 0.002);
  EXPECT_NEAR(there.mean_plane_variance, here.mean_plane_variance, 0.002 * here.mean_plane_variance);
  EXPECT_NEAR(static_cast<double>(there.points), static_cast<double>(here.points), 0.002 * here.points);
}

TEST(MapSharpness, OfANoisyPlaneIsItsNoise)
{
  for (const double sigma : {0.01, 0.03}) {
    const Drive drive = squareFromAbove(10, 12000, 18.0, sigma);
    const MapSharpness sharpness = mapSharpness(drive.scans, drive.poses);
    EXPECT_NEAR(sharpness.mean_plane_variance, sigma * sigma, 0.05 * sigma * sigma);
    EXPECT_NEAR(sharpness.spreadAcrossPlanes(), sigma, 0.03 * sigma);
    EXPECT_NEAR(sharpness.mean_map_entropy, entropyOfDisc(0.3, sigma), 0.1);
  }
}

TEST(MapSharpness, OfAPlaneWithoutNoiseIsThatOfAMillimetre)
{
  const Drive drive = squareFromAbove(10, 12000, 18.0, 0.0);
  const MapSharpness sharpness = mapSharpness(drive.scans, drive.poses);
  EXPECT_NEAR(sharpness.mean_plane_variance, 0.0, 1e-9);
  EXPECT_NEAR(sharpness.mean_map_entropy, entropyOfDisc(0.3, 0.001), 0.1);
}

TEST(MapSharpness, OfOnePlaceIsThatOfAMillimetreAllRound)
{
  const Scan scan(20, Eigen::Vector3f(3.0F, 2.0F, 1.0F));
  const MapSharpness sharpness = mapSharpness({scan, scan}, {SE3(), SE3()});
  EXPECT_EQ(sharpness.points, 1U);
  EXPECT_NEAR(sharpness.mean_map_entropy, 1.5 * std::log(2.0 * kPi * std::exp(1.0) * 1e-6), 1e-9);
  EXPECT_NEAR(sharpness.mean_plane_variance, 0.0, 1e-12);
}

TEST(MapSharpness, IsTheSameOfAPartOfThePoints)
{
  const Drive drive = squareFromAbove(10, 8000, 10.0, 0.03);
  MapSharpnessParameters parameters;
  parameters.points = 2000;
  const MapSharpness sharpness = mapSharpness(drive.scans, drive.poses, parameters);
  EXPECT_NEAR(sharpness.spreadAcrossPlanes(), 0.03, 0.001);
  // Of 20000 points there are 57 in a disc; of 80000 there would be 226.
  parameters.neighbors = 120;
  EXPECT_EQ(mapSharpness(drive.scans, drive.poses, parameters).points, 0U);
  parameters.points = 8000;
  EXPECT_GT(mapSharpness(drive.scans, drive.poses, parameters).points, 4000U);
}

TEST(MapSharpness, OnlyWhatTwoScansSawIsJudged)
{
  Drive drive = squareFromAbove(1, 2000, 4.0, 0.03);
  append(drive, squareFromAbove(1, 2000, 4.0, 0.03, 50.0));
  const MapSharpness none = mapSharpness(drive.scans, drive.poses);
  EXPECT_EQ(none.points, 0U);
  EXPECT_EQ(none.mean_map_entropy, 0.0);
  EXPECT_EQ(none.spreadAcrossPlanes(), 0.0);
  const Drive both = squareFromAbove(2, 2000, 4.0, 0.03, 50.0);
  append(drive, {{both.scans.back()}, {both.poses.back()}});
  EXPECT_NEAR(static_cast<double>(mapSharpness(drive.scans, drive.poses).points),
              static_cast<double>(mapSharpness(both.scans, both.poses).points), 100.0);
}

TEST(MapSharpness, WhatWasSeenOftenDoesNotCountMore)
{
  constexpr double kSigma = 0.03;
  Drive drive = squareFromAbove(2, 20000, 8.0, kSigma);
  append(drive, squareFromAbove(20, 20000, 8.0, 0.0, 50.0));
  // Noise spreads over two voxels' height here and there: between a half and two thirds.
  const MapSharpness sharpness = mapSharpness(drive.scans, drive.poses);
  EXPECT_GT(sharpness.mean_plane_variance, 0.48 * kSigma * kSigma);
  EXPECT_LT(sharpness.mean_plane_variance, 0.68 * kSigma * kSigma);
}

TEST(MapSharpness, IsTheSameEveryTime)
{
  const Drive drive = driveThroughARoom();
  MapSharpnessParameters parameters;
  parameters.points = 10000;
  expectEqual(mapSharpness(drive.scans, drive.poses, parameters), mapSharpness(drive.scans, drive.poses, parameters));
  MapSharpnessEstimation estimation(parameters);
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    estimation.addScan(drive.scans[i], drive.poses[i]);
  }
  expectEqual(estimation.compute(), mapSharpness(drive.scans, drive.poses, parameters));
}

TEST(MapSharpness, PointsThatAreNotFiniteTooNearOrTooFarAreNoPoints)
{
  Drive drive = squareFromAbove(4, 2000, 8.0, 0.03);
  const MapSharpness expected = mapSharpness(drive.scans, drive.poses);
  const float infinity = std::numeric_limits<float>::infinity();
  for (Scan& scan : drive.scans) {
    for (int i = 0; i < 20; ++i) {  // enough to be judged
      for (const float absurd : {0.0F, 0.1F, 121.0F, kNan, infinity, -infinity, 1e30F}) {
        scan.insert(scan.end(), {{absurd, 0.0F, 0.0F}, {0.0F, absurd, 0.0F}, {0.0F, 0.0F, absurd}});
      }
    }
  }
  expectEqual(mapSharpness(drive.scans, drive.poses), expected);
}

TEST(MapSharpness, IsNothingWithoutScansOrPoints)
{
  EXPECT_EQ(mapSharpness({}, {}).points, 0U);
  EXPECT_EQ(mapSharpness({Scan(), Scan()}, {SE3(), SE3()}).points, 0U);
}

TEST(MapSharpness, RefusesSettingsWithoutMeaning)
{
  const auto refused = [](auto MapSharpnessParameters::*member, auto value, const std::string& name) {
    MapSharpnessParameters parameters;
    parameters.*member = value;
    try {
      (void)mapSharpness({}, {}, parameters);
      ADD_FAILURE() << name << ' ' << value;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name + " is "), std::string::npos) << error.what();
    }
  };
  refused(&MapSharpnessParameters::radius, 0.0, "radius");
  refused(&MapSharpnessParameters::radius, -0.3, "radius");
  refused(&MapSharpnessParameters::radius, static_cast<double>(kNan), "radius");
  refused(&MapSharpnessParameters::neighbors, std::size_t{3}, "neighbors");
  refused(&MapSharpnessParameters::points, std::size_t{0}, "points");
  refused(&MapSharpnessParameters::min_range, -1.0, "min_range");
  refused(&MapSharpnessParameters::max_range, 0.5, "max_range");
  refused(&MapSharpnessParameters::max_range, 1e30, "max_range");
}

TEST(MapSharpness, RefusesPosesThatAreNotOfTheScansOrOfNoMap)
{
  EXPECT_THROW((void)mapSharpness({Scan()}, {}), std::invalid_argument);
  EXPECT_THROW((void)mapSharpness({}, {SE3()}), std::invalid_argument);
  for (const double absurd : {static_cast<double>(kNan), 1e9}) {
    const SE3 nowhere(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, absurd, 0.0));
    EXPECT_THROW((void)mapSharpness({Scan(), Scan()}, {SE3(), nowhere}), std::invalid_argument) << absurd;
  }
  const SE3 unturned(Eigen::Matrix3d::Constant(static_cast<double>(kNan)), Eigen::Vector3d::Zero());
  EXPECT_THROW((void)mapSharpness({Scan(), Scan()}, {SE3(), unturned}), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_floam
