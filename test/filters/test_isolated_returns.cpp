// Which returns nothing lies beside.
#include "filters/isolated_returns.h"

#include "support/constants.h"
#include "support/synthetic_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace pcl_floam::test {
namespace {

constexpr double kMissing = 0.0;  // m: no return

/// Of a ring and a column.
using Range = std::function<double(int, int)>;

/// Three scan lines, 2 degrees apart, with columns a fifth of a degree apart.
class ThreeLines {
public:
  static constexpr int kRings = 3;
  static constexpr int kColumns = 401;

  explicit ThreeLines(const Range& range)
  {
    std::vector<Return> returns;
    for (int ring = 0; ring < kRings; ++ring) {
      for (int column = 0; column < kColumns; ++column) {
        const double r = range(ring, column);
        const double azimuth = 0.2 * kPi / 180.0 * column;
        const double elevation = 2.0 * kPi / 180.0 * (ring - 1);
        if (r != kMissing) {
          columns_.push_back(column);
          returns.push_back({{r * std::cos(elevation) * std::cos(azimuth), r * std::cos(elevation) * std::sin(azimuth),
                              r * std::sin(elevation)},
                             ring,
                             column,
                             column / static_cast<double>(kColumns)});
        }
      }
    }
    cloud_ = toCloud(returns);
    const CloudView view = viewOf(cloud_);
    findScanLines(view, SensorModel(), ScanLineSource::ring_field, before);
    after = before;
    IsolatedReturns().leaveOut(view, after);
  }

  [[nodiscard]] bool has(int ring, int column) const
  {
    for (std::int32_t n = after.begin.at(ring); n < after.begin.at(ring + 1); ++n) {
      if (columns_.at(after.index.at(n)) == column) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] std::size_t leftOut() const { return before.index.size() - after.index.size(); }

  ScanLines before;
  ScanLines after;

private:
  pcl::PointCloud<PointXYZIRT> cloud_;
  std::vector<int> columns_;  // of the cloud's points
};

constexpr double kWall = 10.0;  // m

TEST(IsolatedReturns, AreThoseInFrontOfAWallAndBehindIt)
{
  for (const double range : {0.5, 3.0, 8.9, 11.2, 60.0}) {
    const ThreeLines lines([range](int ring, int column) { return ring == 1 && column == 20 ? range : kWall; });
    EXPECT_EQ(lines.leftOut(), 1) << range;
    EXPECT_FALSE(lines.has(1, 20)) << range;
  }
}

/// At the ends of a line, and of the last ones, too; what is left keeps its line and its order.
TEST(IsolatedReturns, AreTakenOutOfTheirLines)
{
  const auto is_stray = [](int ring, int column) { return (column + 7 * ring) % 200 == 0; };
  const ThreeLines lines([&](int ring, int column) { return is_stray(ring, column) ? 3.0 + 5.0 * ring : kWall; });
  ASSERT_EQ(lines.after.lines(), ThreeLines::kRings);
  EXPECT_EQ(lines.leftOut(), 3 + 2 + 2);
  EXPECT_EQ(lines.after.begin.back(), static_cast<std::int32_t>(lines.after.index.size()));
  for (int ring = 0; ring < ThreeLines::kRings; ++ring) {
    for (int column = 0; column < ThreeLines::kColumns; ++column) {
      EXPECT_EQ(lines.has(ring, column), !is_stray(ring, column)) << ring << ' ' << column;
    }
    for (std::int32_t n = lines.after.begin[ring] + 1; n < lines.after.begin[ring + 1]; ++n) {
      EXPECT_LT(lines.after.index[n - 1], lines.after.index[n]);
    }
  }
}

TEST(IsolatedReturns, AreNotThoseOfAThinPost)
{
  const auto post = [](int, int column) { return column == 20 ? 4.0 : kWall; };
  EXPECT_EQ(ThreeLines(post).leftOut(), 0);
  // Two upper lines that see little but the sky: the ground ahead, and a post.
  const auto before_the_sky = [](int ring, int column) {
    const double hill = column < 6 ? 30.0 : kMissing;
    return ring == 0 ? 20.0 : column == 20 ? 76.0 : hill;
  };
  EXPECT_EQ(ThreeLines(before_the_sky).leftOut(), 0);
  const auto no_post = [&](int ring, int column) {
    return column == 20 && ring == 2 ? kMissing : before_the_sky(ring, column);
  };
  EXPECT_EQ(ThreeLines(no_post).leftOut(), 1);
}

/// Told twice, as by a driver of two returns a ray where there was one.
TEST(IsolatedReturns, DoNotBearThemselvesOut)
{
  pcl::PointCloud<PointXYZIRT> cloud;
  for (int column = 0; column < 20; ++column) {
    for (std::uint16_t ring = 0; ring < 2; ++ring) {
      const double r = column == 10 && ring == 0 ? 3.0 : kWall;
      const double azimuth = 0.2 * kPi / 180.0 * column;
      const PointXYZIRT point(static_cast<float>(r * std::cos(azimuth)), static_cast<float>(r * std::sin(azimuth)),
                              0.3F * ring, 1.0F, ring, 0.001F * static_cast<float>(column));
      cloud.push_back(point);
      cloud.push_back(point);
    }
  }
  ScanLines lines;
  findScanLines(viewOf(cloud), SensorModel(), ScanLineSource::ring_field, lines);
  ASSERT_EQ(lines.index.size(), 80);
  IsolatedReturns().leaveOut(viewOf(cloud), lines);
  EXPECT_EQ(lines.index.size(), 78);
}

/// More than a metre apart at 10 m, as a coarse grid leaves them: how far neighbours are to the side is not asked.
TEST(IsolatedReturns, AreNotThoseOfACloudThatWasThinned)
{
  EXPECT_EQ(ThreeLines([](int, int column) { return column % 40 == 0 ? kWall : kMissing; }).leftOut(), 0);
}

/// A ring that lies alone on the ground, whose next ones are far away.
TEST(IsolatedReturns, AreNotThoseOfTheGround)
{
  EXPECT_EQ(ThreeLines([](int ring, int) { return 10.0 * std::pow(3.0, ring); }).leftOut(), 0);
}

/// Leaves, a cable and the wall behind, by turns.
TEST(IsolatedReturns, AreNotThoseOfRaysWithTwoReturns)
{
  EXPECT_EQ(ThreeLines([](int, int column) { return column % 2 == 0 && column < 100 ? 5.0 : kWall; }).leftOut(), 0);
}

TEST(IsolatedReturns, AreNotThoseOfAWallSeenUnderAFlatAngle)
{
  const auto wall = [](int, int column) { return 1.0 / std::tan((3.0 + 0.1 * column) * kPi / 180.0); };
  EXPECT_EQ(ThreeLines(wall).leftOut(), 0);
}

}  // namespace
}  // namespace pcl_floam::test
