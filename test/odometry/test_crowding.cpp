// Whether what fills a part of the view draws the pose away from the rest of the scene.
#include "odometry/crowding.h"

#include <gtest/gtest.h>

namespace pcl_floam {
namespace {

constexpr double kSigma = 0.004;  // m and rad

RegistrationReport converged(const SE3& pose)
{
  RegistrationReport report;
  report.termination = Termination::converged;
  report.target_T_source = pose;
  report.covariance = kSigma * kSigma * Matrix6::Identity();
  return report;
}

/// All features at the pose, spread ones so many standard deviations away, in the sensor's axes.
void compare(Crowding& crowding, const SE3& pose, const Vector6& deviations)
{
  crowding.compare(converged(pose), converged(pose * exp(kSigma * deviations)));
}

Vector6 sideways(double deviations)
{
  return deviations * Vector6::Unit(1);
}

int comparisonsIn(Crowding& crowding, int scans)
{
  int compared = 0;
  for (int i = 0; i < scans; ++i) {
    compared += crowding.isDue() ? 1 : 0;
  }
  return compared;
}

TEST(Crowding, IsComparedInOneScanOfFiveAndMoreOftenInDoubt)
{
  EXPECT_TRUE(Crowding().isDue()) << "the first scan";
  Crowding crowding;
  EXPECT_EQ(comparisonsIn(crowding, 30), 6);
  for (int i = 0; i < 10; ++i) {
    compare(crowding, SE3(), sideways(1.2));
  }
  EXPECT_FALSE(crowding.misleads());
  EXPECT_EQ(comparisonsIn(crowding, 30), 30);
  for (int i = 0; i < 10; ++i) {
    compare(crowding, SE3(), sideways(2.0));
  }
  EXPECT_TRUE(crowding.misleads());
  EXPECT_EQ(comparisonsIn(crowding, 30), 10);
}

TEST(Crowding, MisleadsWhileTheSpreadFeaturesDisagreeAgainAndAgain)
{
  Crowding crowding;
  for (int i = 0; i < 10; ++i) {
    compare(crowding, SE3(), sideways(2.5));
  }
  EXPECT_TRUE(crowding.misleads());
  compare(crowding, SE3(), sideways(0.0));
  EXPECT_TRUE(crowding.misleads());  // one that agrees is not enough
  for (int i = 0; i < 15; ++i) {
    compare(crowding, SE3(), sideways(0.0));
  }
  EXPECT_FALSE(crowding.misleads());
}

TEST(Crowding, NoiseAndOneWildDisagreementDoNotMislead)
{
  Crowding crowding;
  for (int i = 0; i < 20; ++i) {
    compare(crowding, SE3(), sideways(i % 2 == 0 ? 2.5 : -2.5));
    EXPECT_FALSE(crowding.misleads());
  }
  compare(crowding, SE3(), sideways(1000.0));
  EXPECT_FALSE(crowding.misleads());
}

TEST(Crowding, ALorryKeepsItsSideInACurve)
{
  Crowding crowding;
  for (int i = 0; i < 20; ++i) {
    Vector6 turn = Vector6::Zero();
    turn[5] = 0.5 * i;
    compare(crowding, exp(turn), sideways(2.0));
  }
  EXPECT_TRUE(crowding.misleads());
}

TEST(Crowding, DeviationsAreThoseOfTheSensorsAxes)
{
  // The sensor looks along y, where little is known: what differs ahead of it is noise, what differs across is not.
  Vector6 left = Vector6::Zero();
  left[5] = 1.5707963267948966;
  const SE3 pose = exp(left);
  for (const int axis : {0, 1}) {
    Crowding crowding;
    for (int i = 0; i < 10; ++i) {
      RegistrationReport spread = converged(pose * exp(3.0 * kSigma * Vector6::Unit(axis)));
      spread.covariance(1, 1) *= 100.0;
      crowding.compare(converged(pose), spread);
    }
    EXPECT_EQ(crowding.misleads(), axis == 1) << axis;
  }
}

TEST(Crowding, WhatIsSuspectedHoldsUntilManyComparisonsAgree)
{
  Crowding crowding;
  crowding.suspect();
  EXPECT_TRUE(crowding.misleads());
  EXPECT_EQ(comparisonsIn(crowding, 30), 10);
  for (int i = 0; i < 40; ++i) {
    compare(crowding, SE3(), sideways(i % 5 == 0 ? 4.0 : 0.0));  // some still disagree
  }
  EXPECT_TRUE(crowding.misleads());
  for (int i = 0; i < 5; ++i) {
    compare(crowding, SE3(), sideways(0.0));
  }
  EXPECT_FALSE(crowding.misleads());
  EXPECT_EQ(comparisonsIn(crowding, 30), 6);
}

TEST(Crowding, EachDirectionAlongTheGroundCountsBothWays)
{
  for (const int axis : {0, 1, 5}) {
    for (const double deviations : {-2.5, 2.5}) {
      Crowding crowding;
      for (int i = 0; i < 10; ++i) {
        compare(crowding, SE3(), deviations * Vector6::Unit(axis));
      }
      EXPECT_TRUE(crowding.misleads()) << axis << ' ' << deviations;
    }
  }
}

TEST(Crowding, IsNotWhatHasTheGroundHigherOrTilted)
{
  for (const int axis : {2, 3, 4}) {
    Crowding crowding;
    for (int i = 0; i < 10; ++i) {
      compare(crowding, SE3(), 3.0 * Vector6::Unit(axis));
    }
    EXPECT_FALSE(crowding.misleads());
  }
}

TEST(Crowding, WhatDoesNotSeeAllDirectionsTellsNothing)
{
  Crowding crowding;
  crowding.suspect();
  RegistrationReport weak = converged(SE3());
  weak.weak_directions.push_back({Vector6::Unit(0), 1e-6});
  for (int i = 0; i < 30; ++i) {
    crowding.compare(converged(SE3()), weak);
    crowding.compare(weak, converged(SE3()));
  }
  EXPECT_TRUE(crowding.misleads()) << "that they agree along that direction is no agreement";
}

TEST(Crowding, TakesNothingFromWhatIsLockedOrHasFailed)
{
  Crowding crowding;
  for (int i = 0; i < 10; ++i) {
    RegistrationReport spread = converged(exp(sideways(1.0)));
    spread.covariance.setZero();
    crowding.compare(converged(SE3()), spread);
    spread = converged(exp(sideways(1.0)));
    spread.termination = Termination::too_few_correspondences;
    crowding.compare(converged(SE3()), spread);
    EXPECT_FALSE(crowding.misleads());
    RegistrationReport failed;
    failed.target_T_source = exp(sideways(-1.0));
    crowding.compare(failed, converged(SE3()));
    EXPECT_FALSE(crowding.misleads());
  }
  EXPECT_FALSE(crowding.misleads());
  for (int i = 0; i < 10; ++i) {
    compare(crowding, SE3(), sideways(3.0));
  }
  EXPECT_TRUE(crowding.misleads());  // nothing was spoilt
}

}  // namespace
}  // namespace pcl_floam
