// The same scan lines, whatever tells them.
#include "filters/ordered_returns.h"
#include "support/random_motion.h"

#include <pcl_floam/filters/scan_lines.h>

#include <gtest/gtest.h>

#include <set>

namespace pcl_floam::test {
namespace {

TEST(ScanLines, FromTheRingField)
{
  const auto returns = firingOrder();
  const auto cloud = toCloud(returns);
  const ScanLines lines = find(viewOf(cloud));
  EXPECT_EQ(lines.source, ScanLineSource::ring_field);
  EXPECT_FALSE(lines.sorted_by_azimuth);
  expectTrueLines(lines, returns);
}

TEST(ScanLines, FromARingFieldOfAShuffledCloud)
{
  const auto returns = shuffled();
  const auto cloud = toCloud(returns);
  const ScanLines lines = find(viewOf(cloud));
  EXPECT_EQ(lines.source, ScanLineSource::ring_field);
  EXPECT_TRUE(lines.sorted_by_azimuth);
  ASSERT_EQ(lines.index.size(), returns.size());
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    for (std::int32_t n = lines.begin[m] + 1; n < lines.begin[m + 1]; ++n) {
      EXPECT_LE(azimuthOf(returns[static_cast<std::size_t>(lines.index[static_cast<std::size_t>(n) - 1])]),
                azimuthOf(returns[static_cast<std::size_t>(lines.index[static_cast<std::size_t>(n)])]));
    }
  }
}

/// As in a vehicle's frame, and in one where the rings stand upright: there they are no lines that run around.
TEST(ScanLines, OfATurnedFrameOnlyIfTheyRunAround)
{
  for (const double degrees : {0.0, 20.0, 90.0, -90.0, 180.0}) {
    std::vector<Return> returns = firingOrder();
    for (Return& r : returns) {
      r.point = expSO3({degrees * kPi / 180.0, 0.0, 0.0}) * r.point;
    }
    const auto cloud = toCloud(returns);
    const ScanLines lines = find(viewOf(cloud));
    EXPECT_EQ(lines.valid(), std::abs(degrees) != 90.0) << degrees;
    EXPECT_EQ(lines.source, lines.valid() ? ScanLineSource::ring_field : ScanLineSource::automatic) << degrees;
    ScanLines asked;
    findScanLines(viewOf(cloud), SensorModel(), ScanLineSource::ring_field, asked);
    EXPECT_TRUE(asked.valid()) << "who asks for the field, gets it: " << degrees;
  }
}

TEST(ScanLines, FromRingFieldsOfOtherNamesAndTypes)
{
  const auto returns = firingOrder();
  std::vector<std::uint8_t> small;
  std::vector<float> real;
  for (const Return& r : returns) {
    small.push_back(static_cast<std::uint8_t>(r.ring));
    real.push_back(static_cast<float>(r.ring));
  }
  const auto line = CloudBuilder().positions(returns).field("line", small).build();
  EXPECT_EQ(find(viewOf(line)).source, ScanLineSource::ring_field);
  expectTrueLines(find(viewOf(line)), returns);
  const auto channel = CloudBuilder().positions(returns).field("channel", real).build();
  expectTrueLines(find(viewOf(channel)), returns);
}

TEST(ScanLines, ARingFieldLeftAtZeroIsNone)
{
  const auto returns = rowOrder();
  auto cloud = toCloud(returns);
  for (auto& point : cloud) {
    point.ring = 0;
  }
  EXPECT_EQ(find(viewOf(cloud), ScanLineSource::ring_field).failure, ScanLineFailure::source_not_available);
  EXPECT_NE(find(viewOf(cloud)).source, ScanLineSource::ring_field);
  expectTrueLines(find(viewOf(cloud)), returns);
}

TEST(ScanLines, FromRowsAndFromColumns)
{
  const auto rows = rowOrder();
  auto cloud = toPositions(rows);
  cloud.width = 360;
  cloud.height = 16;
  ScanLines lines = find(viewOf(cloud));
  EXPECT_EQ(lines.source, ScanLineSource::organized_rows);
  EXPECT_FALSE(lines.transposed);
  expectTrueLines(lines, rows);

  const auto columns = firingOrder();
  cloud = toPositions(columns);
  cloud.width = 16;
  cloud.height = 360;
  lines = find(viewOf(cloud));
  EXPECT_EQ(lines.source, ScanLineSource::organized_rows);
  EXPECT_TRUE(lines.transposed);
  expectTrueLines(lines, columns);
}

TEST(ScanLines, FromTheFileOrder)
{
  const auto kitti = kittiOrder();
  ScanLines lines = find(viewOf(toPositions(kitti)));
  EXPECT_EQ(lines.source, ScanLineSource::file_order);
  EXPECT_TRUE(lines.kitti_order);
  EXPECT_EQ(lines.lines(), 16U);
  expectTrueLines(lines, kitti);

  const auto from_the_rear = rowOrder();
  lines = find(viewOf(toPositions(from_the_rear)));
  EXPECT_EQ(lines.source, ScanLineSource::file_order);
  EXPECT_FALSE(lines.kitti_order);
  EXPECT_EQ(lines.lines(), 16U);
  expectTrueLines(lines, from_the_rear);
}

TEST(ScanLines, FromTheElevationTable)
{
  for (const auto& returns : {firingOrder(), kittiOrder()}) {
    const ScanLines lines = find(viewOf(toPositions(returns)), ScanLineSource::elevation_table, sensorOf(smallLidar()));
    EXPECT_EQ(lines.source, ScanLineSource::elevation_table);
    expectTrueLines(lines, returns);
  }
  // In the automatic order a named sensor is believed before clusters.
  EXPECT_EQ(find(viewOf(toPositions(firingOrder())), ScanLineSource::automatic, sensorOf(smallLidar())).source,
            ScanLineSource::elevation_table);
}

TEST(ScanLines, FromElevationClusters)
{
  const auto returns = firingOrder();
  const ScanLines lines = find(viewOf(toPositions(returns)));
  EXPECT_EQ(lines.source, ScanLineSource::elevation_clusters);
  EXPECT_FALSE(lines.sorted_by_azimuth);
  expectTrueLines(lines, returns);
}

TEST(ScanLines, AShuffledCloudIsSortedByAzimuth)
{
  const auto returns = shuffled();
  for (const ScanLineSource source : {ScanLineSource::elevation_clusters, ScanLineSource::elevation_table}) {
    ScanLines lines = find(viewOf(toPositions(returns)), source, sensorOf(smallLidar()));
    EXPECT_TRUE(lines.sorted_by_azimuth);
    EXPECT_LT(lines.confidence, 0.9F);
    lines.confidence = 1.0F;
    expectTrueLines(lines, returns);
  }
  EXPECT_FALSE(find(viewOf(toPositions(returns)), ScanLineSource::file_order).valid());
}

TEST(ScanLines, UnmeasuredPointsAreOnNoLine)
{
  const auto returns = kittiOrder();
  auto cloud = toPositions(returns);
  std::set<std::int32_t> gone;
  for (std::size_t i = 5; i < cloud.size(); i += 7) {
    cloud[i].x = i % 2 == 0 ? kNan : 0.0F;
    cloud[i].y = i % 3 == 0 ? std::numeric_limits<float>::infinity() : 0.0F;
    cloud[i].z = 0.0F;
    gone.insert(static_cast<std::int32_t>(i));
  }
  for (const ScanLineSource source : {ScanLineSource::file_order, ScanLineSource::elevation_clusters}) {
    const ScanLines lines = find(viewOf(cloud), source);
    ASSERT_TRUE(lines.valid());
    EXPECT_EQ(lines.lines(), 16U);
    EXPECT_EQ(lines.index.size(), cloud.size() - gone.size());
    for (const std::int32_t index : lines.index) {
      EXPECT_EQ(gone.count(index), 0U);
    }
  }
}

TEST(ScanLines, FailuresHaveReasons)
{
  EXPECT_EQ(find(viewOf(pcl::PointCloud<pcl::PointXYZ>())).failure, ScanLineFailure::empty_cloud);
  pcl::PointCloud<pcl::PointXYZ> cloud(100, 1, pcl::PointXYZ(kNan, 0.0F, 0.0F));
  EXPECT_EQ(find(viewOf(cloud)).failure, ScanLineFailure::empty_cloud);

  std::mt19937 random(2);
  cloud.clear();
  for (int i = 0; i < 20000; ++i) {
    cloud.push_back(pcl::PointXYZ(static_cast<float>(uniform(random, 9.0)), static_cast<float>(uniform(random, 9.0)),
                                  static_cast<float>(uniform(random, 9.0))));
  }
  const auto lines = firingOrder();
  EXPECT_EQ(find(viewOf(toCloud(lines)), ScanLineSource::automatic, sensorModel("solid-state")).failure,
            ScanLineFailure::not_looked_for);
  const ScanLines none = find(viewOf(cloud));
  EXPECT_EQ(none.failure, ScanLineFailure::no_line_structure);
  EXPECT_EQ(none.lines(), 0U);
  EXPECT_TRUE(none.index.empty());
  for (const ScanLineSource source : {ScanLineSource::ring_field, ScanLineSource::organized_rows,
                                      ScanLineSource::file_order, ScanLineSource::elevation_table}) {
    EXPECT_EQ(find(viewOf(cloud), source).failure, ScanLineFailure::source_not_available) << toString(source);
  }
}

/// Of every layout, also where there are more threads than points or lines.
TEST(ScanLines, AllThreadsFindTheSame)
{
  auto rows = toPositions(rowOrder());
  rows.width = 360;
  rows.height = 16;
  const auto few = firingOrder();
  const auto with_rings = toCloud(firingOrder());
  const auto rings_shuffled = toCloud(shuffled());
  const auto few_with_rings = toCloud({few.begin(), few.begin() + 20});
  const auto kitti = toPositions(kittiOrder());
  const auto from_the_rear = toPositions(rowOrder());
  const auto fired = toPositions(firingOrder());
  const auto no_order = toPositions(shuffled());
  const SensorModel sensor = sensorOf(smallLidar());
  for (const CloudView& cloud : {viewOf(with_rings), viewOf(rings_shuffled), viewOf(few_with_rings), viewOf(rows),
                                 viewOf(kitti), viewOf(from_the_rear), viewOf(fired), viewOf(no_order)}) {
    for (const SensorModel& model : {SensorModel(), sensor}) {
      const ScanLines one = find(cloud, ScanLineSource::automatic, model);
      EXPECT_TRUE(one.valid());
      for (const int threads : {2, 3, 7, 30}) {
        const ScanLines lines = find(cloud, ScanLineSource::automatic, model, threads);
        EXPECT_EQ(lines.index, one.index) << toString(one.source);
        EXPECT_EQ(lines.begin, one.begin) << toString(one.source);
        EXPECT_EQ(lines.confidence, one.confidence) << toString(one.source);
        EXPECT_EQ(lines.source, one.source);
        EXPECT_EQ(lines.kitti_order, one.kitti_order);
        EXPECT_EQ(lines.transposed, one.transposed);
        EXPECT_EQ(lines.sorted_by_azimuth, one.sorted_by_azimuth);
      }
    }
  }
}

TEST(ScanLines, ASensorHasNotEndlesslyManyBeams)
{
  SensorModel sensor;
  sensor.name = "many";
  for (int beam = 0; beam < 2000; ++beam) {
    sensor.elevations.push_back(0.0005F * static_cast<float>(beam));
  }
  EXPECT_FALSE(find(viewOf(toPositions(firingOrder())), ScanLineSource::elevation_table, sensor).valid());
  EXPECT_THROW(static_cast<void>(customSensor("many", std::vector<float>(1025, 1.0F))), std::invalid_argument);
}

TEST(ScanLines, AFewScatteredElevationsAreNoClusters)
{
  // So few points that chance alone puts some side by side and leaves gaps between them.
  std::mt19937 random(4);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int i = 0; i < 500; ++i) {
    const double azimuth = uniform(random, kPi);
    const double elevation = uniform(random, 10.0 * kPi / 180.0);
    cloud.push_back(pcl::PointXYZ(static_cast<float>(5.0 * std::cos(azimuth) * std::cos(elevation)),
                                  static_cast<float>(5.0 * std::sin(azimuth) * std::cos(elevation)),
                                  static_cast<float>(5.0 * std::sin(elevation))));
  }
  EXPECT_EQ(find(viewOf(cloud)).failure, ScanLineFailure::no_line_structure);
  EXPECT_FALSE(find(viewOf(cloud), ScanLineSource::elevation_clusters).valid());
}

}  // namespace
}  // namespace pcl_floam::test
