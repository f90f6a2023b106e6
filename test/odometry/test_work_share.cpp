// How much of a start's work one sweep bears.
#include "odometry/work_share.h"

#include <gtest/gtest.h>

namespace pcl_floam {

TEST(WorkShare, BearsWhatIsLeftBesideTheTracksThatAreFollowed)
{
  constexpr int kEffort = 20;
  for (const std::size_t followed : {1U, 4U}) {
    WorkShare share(kEffort, followed);
    int caught_up = 0;
    while (share.take(WorkShare::kCatchUp)) {
      ++caught_up;
    }
    const double left = kEffort - WorkShare::kFollow * (static_cast<double>(followed) - 1.0);
    EXPECT_EQ(caught_up, static_cast<int>(left / WorkShare::kCatchUp)) << followed;
  }
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
