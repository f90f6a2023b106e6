// Scans are saved as what turned out to be true of them, not as what was supposed when they came.

#include "support/temporary_folder.h"

#include "scan_saver.h"
#include "support/constants.h"

#include <pcl_floam/common/point_types.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

namespace pcl_floam::tools {
namespace {

using pcl_floam::test::kPi;

constexpr double kRadius = 10.0;  // m

/// A scan of sixteen rings, column by column, whose points have no times.
pcl::PCLPointCloud2 scan()
{
  pcl::PointCloud<PointXYZIRT> cloud;
  for (int column = 0; column < 900; ++column) {
    const double azimuth = kPi - 2.0 * kPi * column / 900.0;
    for (int ring = 0; ring < 16; ++ring) {
      cloud.push_back({static_cast<float>(kRadius * std::cos(azimuth)), static_cast<float>(kRadius * std::sin(azimuth)),
                       static_cast<float>(0.35 * (ring - 8)), 0.0F, static_cast<std::uint16_t>(ring), 0.0F});
    }
  }
  pcl::PCLPointCloud2 message;
  pcl::toPCLPointCloud2(cloud, message);
  const auto isTime = [](const pcl::PCLPointField& field) { return field.name == "time"; };
  message.fields.erase(std::remove_if(message.fields.begin(), message.fields.end(), isTime), message.fields.end());
  return message;
}

OdometryReport reportAt(double x, ScanTimingSource timing)
{
  OdometryReport report;
  report.world_T_sensor.translation.x() = x;
  report.timing_source = timing;
  return report;
}

/// m, by which a saved scan's points lie off the cylinder on which they were measured.
double greatestMove(const std::filesystem::path& file)
{
  pcl::PCLPointCloud2 message;
  ScanSource(file.parent_path()).read(0, message);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  pcl::fromPCLPointCloud2(message, cloud);
  double move = 0.0;
  for (const pcl::PointXYZ& point : cloud) {
    move = std::max(move, std::abs(std::hypot(double{point.x}, double{point.y}) - kRadius));
  }
  return move;
}

class ScanSaving : public testing::Test {
protected:
  void save(ScanSaver& saver, std::size_t number, const OdometryReport& report)
  {
    pcl::PCLPointCloud2 cloud = scan();
    saver.save(number, 0.1 * static_cast<double>(number), cloud, report, parameters_);
  }

  OdometryParameters parameters_;
  test::TemporaryFolder folder_;
};

TEST_F(ScanSaving, WaitsWhilePosesAreProvisional)
{
  ScanSaver saver(folder_.path() / "saved");
  OdometryReport first = reportAt(0.0, ScanTimingSource::none);
  first.provisional = true;
  save(saver, 0, first);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "saved" / numberedName(0)));
  // The sensor moved by 2 m a scan, and the azimuth tells when.
  OdometryReport second = reportAt(2.0, ScanTimingSource::clockwise);
  second.corrected_poses = {SE3()};
  save(saver, 1, second);
  saver.finish();
  EXPECT_GT(greatestMove(folder_.path() / "saved" / numberedName(0)), 0.5);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "saved" / numberedName(1)));
}

TEST_F(ScanSaving, WritesAtTheEndWhatStillWaits)
{
  ScanSaver saver(folder_.path() / "saved");
  OdometryReport report = reportAt(0.0, ScanTimingSource::none);
  report.provisional = true;
  save(saver, 0, report);
  saver.finish();
  EXPECT_LT(greatestMove(folder_.path() / "saved" / numberedName(0)), 1e-4);
}

}  // namespace
}  // namespace pcl_floam::tools
