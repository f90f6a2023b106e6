// Undoing the distortion of a sweep whose motion is known.
// PointXYZIRT is no type of PCL's own.
#define PCL_NO_PRECOMPILE
#include "support/constants.h"
#include "support/random_motion.h"
#include "support/synthetic_cloud.h"

#include <pcl_floam/filters/motion_compensation.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

using Cloud = pcl::PointCloud<PointXYZIRT>;

constexpr int kPoints = 500;

const Vector6 kTwist = (Vector6() << 1.2, -0.3, 0.1, 0.05, -0.04, 0.2).finished();

/// Static points around the sensor's pose at the sweep's start.
std::vector<Eigen::Vector3d> staticPoints()
{
  std::mt19937 random(1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kPoints; ++i) {
    points.emplace_back(5.0 + uniform(random, 15.0), uniform(random, 20.0), uniform(random, 3.0));
  }
  return points;
}

double fractionOfPoint(std::size_t i)
{
  return static_cast<double>(i) / (kPoints - 1);
}

/// Each point as a sensor that moves by the twist sees it when it comes to it.
Cloud distortedCloud(const Vector6& twist = kTwist)
{
  const auto points = staticPoints();
  Cloud cloud;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double fraction = fractionOfPoint(i);
    const Eigen::Vector3f p = (exp(Vector6(fraction * twist)).inverse() * points[i]).cast<float>();
    cloud.push_back(PointXYZIRT(p.x(), p.y(), p.z(), 0.1F * static_cast<float>(i), static_cast<std::uint16_t>(i % 16),
                                static_cast<float>(0.1 * fraction)));
  }
  return cloud;
}

MotionCompensation<PointXYZIRT> compensationOf(const Cloud& cloud, PoseInstant instant = PoseInstant::end)
{
  MotionCompensation<PointXYZIRT> compensation;
  compensation.setInputCloud(pcl::make_shared<Cloud>(cloud));
  compensation.setTwist(kTwist);
  compensation.setReferenceInstant(instant);
  return compensation;
}

void expectSamePlaces(const Cloud& a, const Cloud& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].getVector3fMap(), b[i].getVector3fMap()) << i;
  }
}

TEST(MotionCompensation, GivesBackTheStaticPointsAtEveryInstant)
{
  const auto points = staticPoints();
  const Cloud cloud = distortedCloud();
  for (const PoseInstant instant : {PoseInstant::start, PoseInstant::middle, PoseInstant::end}) {
    Cloud output;
    compensationOf(cloud, instant).filter(output);
    ASSERT_EQ(output.size(), cloud.size());
    const SE3 sensor_T_start = exp(Vector6(fractionOf(instant) * kTwist)).inverse();
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_LT((output[i].getVector3fMap().cast<double>() - sensor_T_start * points[i]).norm(), 1e-4)
          << toString(instant) << ", point " << i;
      EXPECT_EQ(output[i].time, cloud[i].time);
      EXPECT_EQ(output[i].ring, cloud[i].ring);
      EXPECT_EQ(output[i].intensity, cloud[i].intensity);
    }
  }
}

TEST(MotionCompensation, UndoesAnAcceleratedMotionToo)
{
  const Vector6 acceleration = (Vector6() << 0.4, 0.1, -0.05, 0.02, 0.05, -0.1).finished();
  const SweepMotion motion(kTwist, 0.5, acceleration);
  const auto points = staticPoints();
  Cloud cloud = distortedCloud();
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud[i].getVector3fMap() = (motion.at(fractionOfPoint(i)).inverse() * points[i]).cast<float>();
  }
  for (const PoseInstant instant : {PoseInstant::start, PoseInstant::middle, PoseInstant::end}) {
    auto compensation = compensationOf(cloud, instant);
    compensation.setAcceleration(acceleration);
    Cloud output;
    compensation.filter(output);
    const SE3 sensor_T_middle = motion.at(fractionOf(instant)).inverse();
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_LT((output[i].getVector3fMap().cast<double>() - sensor_T_middle * points[i]).norm(), 1e-4)
          << toString(instant) << ", point " << i;
    }
  }
  MotionCompensation<PointXYZIRT> compensation;
  EXPECT_THROW(compensation.setAcceleration(Vector6::Constant(std::numeric_limits<double>::quiet_NaN())),
               std::invalid_argument);
}

TEST(MotionCompensation, PointsOfTheReferenceInstantStay)
{
  const Cloud cloud = distortedCloud();
  Cloud output;
  compensationOf(cloud, PoseInstant::end).filter(output);
  EXPECT_LT((output.back().getVector3fMap() - cloud.back().getVector3fMap()).norm(), 1e-5F);
  EXPECT_GT((output.front().getVector3fMap() - cloud.front().getVector3fMap()).norm(), 1.0F);
  compensationOf(cloud, PoseInstant::start).filter(output);
  EXPECT_LT((output.front().getVector3fMap() - cloud.front().getVector3fMap()).norm(), 1e-5F);
}

TEST(MotionCompensation, TheOppositeTwistUndoesIt)
{
  const Cloud cloud = distortedCloud();
  Cloud output;
  compensationOf(cloud).filter(output);
  auto back = compensationOf(output);
  back.setTwist(-kTwist);
  Cloud again;
  back.filter(again);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT((again[i].getVector3fMap() - cloud[i].getVector3fMap()).norm(), 2e-5F);
  }
}

TEST(MotionCompensation, MotionMayBeGivenAsAPose)
{
  const Cloud cloud = distortedCloud();
  auto by_twist = compensationOf(cloud);
  auto by_pose = compensationOf(cloud);
  by_pose.setMotion(exp(kTwist).isometry());
  EXPECT_LT((by_pose.getTwist() - kTwist).norm(), 1e-12);
  auto by_se3 = compensationOf(cloud);
  by_se3.setMotion(exp(kTwist));
  EXPECT_LT((by_se3.getTwist() - kTwist).norm(), 1e-12);
  EXPECT_LT(log(by_se3.getMotion().inverse() * exp(kTwist)).norm(), 1e-12);
}

TEST(MotionCompensation, PointsThatAreNotFiniteAreLeftAlone)
{
  Cloud cloud = distortedCloud();
  cloud[7].x = kNan;
  cloud[9].z = std::numeric_limits<float>::infinity();
  cloud.is_dense = false;
  Cloud output;
  compensationOf(cloud).filter(output);
  EXPECT_TRUE(std::isnan(output[7].x));
  EXPECT_EQ(output[7].y, cloud[7].y);
  EXPECT_EQ(output[9].x, cloud[9].x);
  EXPECT_TRUE(pcl::isFinite(output[8]));
}

TEST(MotionCompensation, NoMotionIsACopy)
{
  const Cloud cloud = distortedCloud();
  auto compensation = compensationOf(cloud);
  compensation.setTwist(Vector6::Zero());
  Cloud output;
  compensation.filter(output);
  expectSamePlaces(output, cloud);
}

TEST(MotionCompensation, OutputMayBeTheInput)
{
  const auto cloud = pcl::make_shared<Cloud>(distortedCloud());
  Cloud expected;
  compensationOf(*cloud).filter(expected);
  auto in_place = compensationOf(*cloud);
  in_place.setInputCloud(cloud);
  in_place.filter(*cloud);
  expectSamePlaces(*cloud, expected);
}

TEST(MotionCompensation, IndicesSelectAndOrder)
{
  const Cloud cloud = distortedCloud();
  Cloud all;
  compensationOf(cloud).filter(all);
  auto compensation = compensationOf(cloud);
  const auto indices = pcl::make_shared<pcl::Indices>(pcl::Indices{400, 3, 250});
  compensation.setIndices(indices);
  Cloud some;
  compensation.filter(some);
  ASSERT_EQ(some.size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) {
    const auto i = static_cast<std::size_t>((*indices)[n]);
    EXPECT_EQ(some[n].getVector3fMap(), all[i].getVector3fMap());
    EXPECT_EQ(some[n].time, cloud[i].time);
  }
}

TEST(MotionCompensation, UndistortsASweepWithoutTimesByItsAzimuths)
{
  // The floor of a room, seen by a sensor that climbs: level again after compensation.
  const Vector6 climb = (Vector6() << 0.0, 0.0, 0.5, 0.0, 0.0, 0.0).finished();
  const Room room;
  const auto returns = sweepRoom(room, Lidar(), [&](double fraction) { return exp(Vector6(fraction * climb)); });
  MotionCompensation<pcl::PointXYZ> compensation;
  compensation.setInputCloud(pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(toPositions(returns)));
  compensation.setTwist(climb);
  compensation.setReferenceInstant(PoseInstant::start);
  pcl::PointCloud<pcl::PointXYZ> output;
  compensation.filter(output);
  EXPECT_EQ(compensation.getScanTiming().source, ScanTimingSource::azimuth);
  double lowest = 0.0;
  for (const auto& point : output) {
    lowest = std::min(lowest, static_cast<double>(point.z));
  }
  EXPECT_NEAR(lowest, room.walls.lowest[2], 0.002);
  for (const unsigned int threads : {2U, 3U, 8U}) {
    compensation.setNumberOfThreads(threads);
    pcl::PointCloud<pcl::PointXYZ> same;
    compensation.filter(same);
    ASSERT_EQ(same.size(), output.size());
    for (std::size_t i = 0; i < same.size(); ++i) {
      ASSERT_EQ(same[i].getVector3fMap(), output[i].getVector3fMap()) << threads << " threads";
    }
  }
}

TEST(MotionCompensation, FollowsTheBaseAsAnyFilter)
{
  const auto cloud = pcl::make_shared<Cloud>(distortedCloud());
  auto filter = pcl::make_shared<MotionCompensation<PointXYZIRT>>();
  filter->setTwist(kTwist);
  const pcl::Filter<PointXYZIRT>::Ptr base = filter;
  base->setInputCloud(cloud);
  Cloud output;
  base->filter(output);
  EXPECT_EQ(output.size(), cloud->size());
  EXPECT_NE(output.front().getVector3fMap(), cloud->front().getVector3fMap());
}

TEST(MotionCompensation, WithoutTimesTheOutputIsACopy)
{
  pcl::PointCloud<pcl::PointXYZ> cloud(2, 1, pcl::PointXYZ(5.0F, 1.0F, 0.0F));
  MotionCompensation<pcl::PointXYZ> compensation;
  compensation.setInputCloud(cloud.makeShared());
  compensation.setTwist(kTwist);
  pcl::PointCloud<pcl::PointXYZ> output;
  compensation.filter(output);
  EXPECT_FALSE(compensation.getScanTiming().valid());
  EXPECT_EQ(output[0].getVector3fMap(), cloud[0].getVector3fMap());
}

TEST(MotionCompensation, RefusesAMotionThatIsNotFinite)
{
  MotionCompensation<PointXYZIRT> compensation;
  Vector6 twist = kTwist;
  twist[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(compensation.setTwist(twist), std::invalid_argument);
}

TEST(MotionCompensation, IndicesBeyondTheCloudAreRefused)
{
  const Cloud cloud = distortedCloud();
  for (const int index : {-1, kPoints, 1000000}) {
    MotionCompensation<PointXYZIRT> compensation = compensationOf(cloud);
    compensation.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{0, kPoints - 1, index}));
    Cloud output;
    EXPECT_THROW(compensation.filter(output), std::invalid_argument) << index;
  }
}

}  // namespace
}  // namespace pcl_floam::test
