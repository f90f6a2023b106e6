// How much of a start's work one sweep bears.
#include "odometry/work_share.h"

#include <gtest/gtest.h>

namespace pcl_floam {

namespace {

/// Sweeps of before that a late track takes in beside one.
int caughtUp(double effort, std::size_t followed)
{
  WorkShare share(effort, followed);
  int caught_up = 0;
  while (share.take(WorkShare::kCatchUp)) {
    ++caught_up;
  }
  return caught_up;
}

}  // namespace

TEST(WorkShare, MoreEffortCatchesUpMore)
{
  EXPECT_GT(caughtUp(20, 1), caughtUp(10, 1));
  EXPECT_GT(caughtUp(40, 1), caughtUp(20, 1));
  EXPECT_LE(caughtUp(20, 1), 20) << "a sweep of before is a registration at least";
}

TEST(WorkShare, TracksThatAreFollowedLeaveLess)
{
  EXPECT_LT(caughtUp(20, 4), caughtUp(20, 1));
  EXPECT_LT(caughtUp(20, 8), caughtUp(20, 4));
}

TEST(WorkShare, GoesOnHoweverMuchAPartCosts)
{
  WorkShare share(2, 1);
  EXPECT_TRUE(share.take(1000.0));
  EXPECT_FALSE(share.take(0.1));
}

/// Else sweeps would come as fast as a late track takes them.
TEST(WorkShare, ALateTrackAlwaysCatchesUp)
{
  WorkShare share(2, 12);
  EXPECT_TRUE(share.take(WorkShare::kCatchUp));
  EXPECT_TRUE(share.take(WorkShare::kCatchUp));
}

}  // namespace pcl_floam
