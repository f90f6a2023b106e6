// How much of a start one scan has to bear.
#include "support/counting_map.h"
#include "support/moving_room.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

namespace pcl_floam::test {
namespace {

constexpr int kAllAtOnce = 1000;

struct StartedRun {
  std::vector<double> places;  // looked up and taken in, for each scan
  int provisional = 0;
  SE3 last;
};

StartedRun runWith(int effort)
{
  constexpr int kManyScans = 50;
  OdometryParameters parameters = defaults();
  parameters.start_effort = effort;
  const auto counts = std::make_shared<CountingMap::Counts>();
  OdometryComponents components;
  components.map = std::make_shared<CountingMap>(counts);
  Odometry<PointXYZIRT> odometry(parameters);
  odometry.setComponents(components);
  StartedRun run;
  for (int k = 0; k < kManyScans; ++k) {
    const int before = counts->places;
    odometry.track(sweep([](double t) { return steadyPath(0.2 * t); }, k));
    run.places.push_back(counts->places - before);
    run.provisional += odometry.report().provisional ? 1 : 0;
    run.last = odometry.getPose();
  }
  return run;
}

/// In work of a scan long after the start, which the map takes in.
double greatestShare(const StartedRun& run)
{
  const double usual = *std::max_element(run.places.end() - 15, run.places.end());
  return *std::max_element(run.places.begin(), run.places.end()) / usual;
}

/// The engine 'features' seeks no motion.
class StartEffort : public testing::Test {
protected:
  void SetUp() override
  {
    if (isByFeatures()) {
      GTEST_SKIP() << "of the engine 'surfaces'";
    }
  }
};

TEST_F(StartEffort, NoScanBearsManyTimesAsMuchAsAnother)
{
  EXPECT_LT(greatestShare(runWith(OdometryParameters().start_effort)), 6.0);
  EXPECT_GT(greatestShare(runWith(kAllAtOnce)), 12.0);
}

TEST_F(StartEffort, DecidesWhenTheStartIsSettledNotHow)
{
  const StartedRun little = runWith(2);
  const StartedRun usual = runWith(OdometryParameters().start_effort);
  const StartedRun all = runWith(kAllAtOnce);
  EXPECT_LT(little.provisional, static_cast<int>(little.places.size())) << "it ends";
  EXPECT_GT(little.provisional, usual.provisional);
  EXPECT_GT(usual.provisional, all.provisional);
  EXPECT_EQ(all.provisional, 0);
  for (const StartedRun& run : {little, usual}) {
    EXPECT_LT((run.last.translation - all.last.translation).norm(), 5e-3);
  }
}

TEST_F(StartEffort, OutOfRangeIsRefused)
{
  OdometryParameters parameters = defaults();
  for (const int effort : {1, kAllAtOnce + 1}) {
    parameters.start_effort = effort;
    EXPECT_THROW(OdometryPipeline{parameters}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace pcl_floam::test
