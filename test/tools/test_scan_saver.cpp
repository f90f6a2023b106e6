// Scans are saved as what turned out to be true of them, not as what was supposed when they came.

#include "support/temporary_folder.h"

#include "scan_saver.h"

#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <cmath>

namespace pcl_floam::tools {
namespace {

constexpr float kRadius = 10.0F;  // m

/// A ring of points that have no times.
pcl::PCLPointCloud2 ring()
{
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int i = 0; i < 360; ++i) {
    const auto angle = static_cast<float>(M_PI * (180.0 - i) / 180.0);
    cloud.push_back({kRadius * std::cos(angle), kRadius * std::sin(angle), 0.0F});
  }
  pcl::PCLPointCloud2 message;
  pcl::toPCLPointCloud2(cloud, message);
  return message;
}

OdometryReport reportAt(double x, ScanTimingSource timing)
{
  OdometryReport report;
  report.world_T_sensor.translation.x() = x;
  report.timing_source = timing;
  report.rotation = ScanRotation::clockwise;
  return report;
}

/// m, of a saved scan's points from the ring.
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
  ScanSaving() { parameters_.structure = ScanStructure::space; }

  void save(ScanSaver& saver, std::size_t scan, const OdometryReport& report)
  {
    pcl::PCLPointCloud2 cloud = ring();
    saver.save(scan, 0.1 * static_cast<double>(scan), cloud, report, parameters_);
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
  OdometryReport second = reportAt(2.0, ScanTimingSource::azimuth);
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
