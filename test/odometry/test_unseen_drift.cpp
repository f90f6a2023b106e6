// What a pose may be off along directions that are not seen.
#include "odometry/unseen_drift.h"

#include <gtest/gtest.h>

namespace pcl_floam {
namespace {

WeakDirection along(const Vector6& direction)
{
  WeakDirection weak;
  weak.direction = direction.normalized();
  return weak;
}

TEST(UnseenDrift, GrowsWithTheTimeAndTheErrorOfTheVelocity)
{
  Matrix6 velocity = Matrix6::Zero();
  velocity.diagonal() << 0.04, 0.01, 0.01, 1e-4, 1e-4, 1e-4;
  UnseenDrift drift;
  for (int i = 0; i < 10; ++i) {
    drift.carryOn(velocity, 1.0);
    drift.see({along(Vector6::UnitX())});
  }
  // A velocity that is off by 0.2 m per period all the time: 2 m after ten.
  EXPECT_NEAR(drift.covariance()(0, 0), 4.0, 1e-9);
  EXPECT_TRUE(drift.covariance().bottomRightCorner(5, 5).isZero(1e-12));
  UnseenDrift at_once;
  at_once.carryOn(velocity, 10.0);
  EXPECT_TRUE(at_once.covariance().isApprox(100.0 * velocity));  // nothing was seen
}

TEST(UnseenDrift, EndsWhenTheDirectionIsSeenInTenScans)
{
  const Matrix6 velocity = 0.01 * Matrix6::Identity();
  UnseenDrift drift;
  drift.carryOn(velocity, 5.0);
  drift.see({along(Vector6::UnitX())});
  for (int i = 0; i < 9; ++i) {
    drift.carryOn(velocity, 1.0);
    drift.see({});
  }
  EXPECT_NEAR(drift.covariance()(0, 0), 14.0 * 14.0 * 0.01, 1e-9);  // it may have been chance
  drift.carryOn(velocity, 1.0);
  drift.see({});
  EXPECT_TRUE(drift.covariance().isZero(0.0));
  drift.carryOn(velocity, 1.0);
  EXPECT_TRUE(drift.covariance().isApprox(velocity));  // nothing is left of before
}

TEST(UnseenDrift, StaysOnceTheMapHasDriftedAlong)
{
  const Matrix6 velocity = 0.01 * Matrix6::Identity();
  UnseenDrift drift;
  drift.carryOn(velocity, 5.0);
  drift.see({along(Vector6::UnitX())});
  drift.enterMap();
  for (int i = 0; i < 10; ++i) {
    drift.carryOn(velocity, 1.0);
    drift.see({});
  }
  Matrix6 left = Matrix6::Zero();
  left(0, 0) = 0.25;  // of what came after nothing
  EXPECT_TRUE(drift.covariance().isApprox(left));
  for (int i = 0; i < 100; ++i) {  // weak directions are named a little differently from scan to scan
    drift.carryOn(Matrix6::Zero(), 1.0);
    drift.see({along(Vector6::UnitX() + (i % 2 == 0 ? 0.1 : -0.1) * Vector6::UnitY())});
    drift.enterMap();
  }
  EXPECT_TRUE(drift.covariance().isApprox(left));
}

TEST(UnseenDrift, OneWeakScanLeavesNoMoreThanItsOwnDrift)
{
  const Matrix6 velocity = 0.01 * Matrix6::Identity();
  UnseenDrift drift;
  for (int i = 0; i < 20; ++i) {
    drift.carryOn(velocity, 1.0);
    drift.see(i == 5 ? std::vector<WeakDirection>{along(Vector6::UnitX())} : std::vector<WeakDirection>{});
    drift.enterMap();
  }
  EXPECT_NEAR(drift.covariance()(0, 0), 0.01, 1e-9);
  EXPECT_NEAR(drift.covariance().trace(), 0.01, 1e-9);
}

TEST(UnseenDrift, ASensorThatSawNothingAndSeesAgainIsWhereItIs)
{
  UnseenDrift drift;
  drift.carryOn(0.01 * Matrix6::Identity(), 10.0);
  drift.see({});
  EXPECT_TRUE(drift.covariance().isZero(0.0));
}

TEST(UnseenDrift, GrowsAlongADirectionThatIsBothTranslationAndRotation)
{
  Vector6 direction;
  direction << 0.8, 0.0, 0.0, 0.0, 0.0, 0.6;
  UnseenDrift drift;
  for (int i = 0; i < 10; ++i) {
    drift.carryOn(0.01 * Matrix6::Identity(), 1.0);
    drift.see({along(direction)});
  }
  EXPECT_NEAR(drift.covariance()(0, 0), 1.0, 1e-9);
  EXPECT_NEAR(drift.covariance()(5, 5), 1.0, 1e-9);
  EXPECT_NEAR(drift.covariance().trace(), 2.0, 1e-9);
}

TEST(UnseenDrift, TwoDirectionsThatAreNotAtRightAnglesSpanAPlane)
{
  UnseenDrift drift;
  drift.carryOn(0.01 * Matrix6::Identity(), 2.0);
  drift.see({along(Vector6::UnitX()), along(Vector6::UnitX() + 2.0 * Vector6::UnitY())});
  EXPECT_NEAR(drift.covariance()(0, 0), 0.04, 1e-9);
  EXPECT_NEAR(drift.covariance()(1, 1), 0.04, 1e-9);
  EXPECT_NEAR(drift.covariance().trace(), 0.08, 1e-9);
}

TEST(UnseenDrift, IsAlongTheDirectionWhateverItIs)
{
  Vector6 direction = Vector6::Zero();
  direction.head<3>() = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  UnseenDrift drift;
  drift.carryOn(0.01 * Matrix6::Identity(), 3.0);
  drift.see({along(direction)});
  EXPECT_NEAR(direction.dot(drift.covariance() * direction), 0.09, 1e-9);
  EXPECT_NEAR(drift.covariance().trace(), 0.09, 1e-9);
}

}  // namespace
}  // namespace pcl_floam
