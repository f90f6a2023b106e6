// What the simulator writes to disk.

#include "dataset_writer.h"
#include "support/constants.h"
#include "support/temporary_folder.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <pcl/io/pcd_io.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_floam::simulator {

namespace {

using pcl_floam::test::kPi;

SimulationOptions smallOptions()
{
  SimulationOptions options;
  options.world = "room";
  options.start = 3.0;
  return options;
}

using BinPoint = std::array<float, 4>;

std::vector<BinPoint> readBin(const std::filesystem::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::vector<BinPoint> points;
  BinPoint point{};
  while (stream.read(reinterpret_cast<char*>(point.data()), sizeof(point))) {
    points.push_back(point);
  }
  return points;
}

std::vector<std::vector<double>> readNumbers(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    rows.emplace_back();
    for (double number = 0.0; words >> number;) {
      rows.back().push_back(number);
    }
  }
  return rows;
}

}  // namespace

TEST(DatasetWriter, PcdHoldsTheSweep)
{
  const test::TemporaryFolder folder;
  Simulation simulation(smallOptions());
  const Sweep sweep = simulation.sweep(0);
  DatasetWriter(folder.path(), DatasetFormat::pcd).write(sweep);
  pcl::PointCloud<PointXYZIRT> read;
  ASSERT_EQ(pcl::io::loadPCDFile((folder.path() / "scans/000000.pcd").string(), read), 0);
  ASSERT_EQ(read.size(), sweep.cloud.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    ASSERT_TRUE(read[i].getVector3fMap() == sweep.cloud[i].getVector3fMap());
    ASSERT_EQ(read[i].ring, sweep.cloud[i].ring);
    ASSERT_EQ(read[i].time, sweep.cloud[i].time);
    ASSERT_EQ(read[i].intensity, sweep.cloud[i].intensity);
  }
}

TEST(DatasetWriter, LivoxFieldsAreItsDrivers)
{
  const test::TemporaryFolder folder;
  SimulationOptions options = smallOptions();
  options.sensor = "avia";
  Simulation simulation(options);
  ASSERT_TRUE(simulation.sensor().isLivox());
  const Sweep sweep = simulation.sweep(2);
  DatasetWriter(folder.path(), DatasetFormat::livox).write(sweep);
  pcl::PCLPointCloud2 read;
  ScanSource(folder.path() / "scans").read(0, read);
  ASSERT_EQ(read.width * read.height, sweep.cloud.size());
  const CloudView view = viewOf(read);
  ASSERT_TRUE(view.ring.exists());
  ASSERT_TRUE(view.time.exists());
  const std::size_t last = sweep.cloud.size() - 1;
  EXPECT_EQ(view.x(last), sweep.cloud[last].x);
  EXPECT_EQ(view.z(last), sweep.cloud[last].z);
  const std::uint8_t* point = &read.data[last * read.point_step];
  double stamp = 0.0;
  std::memcpy(&stamp, point + 18, sizeof(stamp));
  EXPECT_EQ(read.point_step, 26U);
  EXPECT_EQ(point[17], sweep.cloud[last].ring);
  EXPECT_NEAR(stamp, 1e9 * (sweep.start_time + static_cast<double>(sweep.cloud[last].time)), 1.0);
}

TEST(DatasetWriter, SweepsWithoutAReturnAreEmptyScans)
{
  const test::TemporaryFolder folder;
  SimulationOptions options = smallOptions();
  options.gap_to = 0.1;
  Simulation simulation(options);
  {
    DatasetWriter writer(folder.path(), DatasetFormat::pcd);
    writer.write(simulation.sweep(0));
    writer.write(simulation.sweep(1));
  }
  const ScanSource scans(folder.path() / "scans");
  ASSERT_EQ(scans.size(), 2U);
  pcl::PCLPointCloud2 empty;
  pcl::PCLPointCloud2 full;
  scans.read(0, empty);
  scans.read(1, full);
  EXPECT_EQ(empty.width * empty.height, 0U);
  EXPECT_GT(full.width * full.height, 1000U);
  ASSERT_EQ(empty.fields.size(), full.fields.size());
  for (std::size_t i = 0; i < full.fields.size(); ++i) {
    EXPECT_EQ(empty.fields[i].name, full.fields[i].name);
    EXPECT_EQ(empty.fields[i].datatype, full.fields[i].datatype);
  }
}

TEST(DatasetWriter, KittiOrderIsRingByRingFromTheTop)
{
  for (const char* sensor : {"hdl64", "os64"}) {
    const test::TemporaryFolder folder;
    SimulationOptions options = smallOptions();
    options.sensor = sensor;
    Simulation simulation(options);
    const Sweep sweep = simulation.sweep(0);
    DatasetWriter(folder.path(), DatasetFormat::kitti).write(sweep);
    const std::vector<BinPoint> points = readBin(folder.path() / "velodyne/000000.bin");
    ASSERT_EQ(points.size(), sweep.cloud.size());
    int rings = 1;
    double previous_azimuth = 0.0;
    double previous_elevation = kPi;
    for (const auto& [x, y, z, intensity] : points) {
      const double azimuth = std::atan2(y, x) + (y < 0.0F ? 2.0 * kPi : 0.0);
      const double elevation = std::atan2(z, std::hypot(x, y));
      rings += azimuth < previous_azimuth - 4.0 ? 1 : 0;
      ASSERT_TRUE(azimuth >= previous_azimuth - 1e-5 || azimuth < previous_azimuth - 4.0);
      ASSERT_LT(elevation, previous_elevation + 1e-3);
      ASSERT_GE(intensity, 0.0F);
      ASSERT_LE(intensity, 1.0F);
      previous_azimuth = azimuth;
      previous_elevation = elevation;
    }
    EXPECT_EQ(rings, 64) << sensor;
  }
}

TEST(DatasetWriter, PosesAndTimesBelongToTheSweeps)
{
  const test::TemporaryFolder folder;
  Simulation simulation(smallOptions());
  {
    DatasetWriter writer(folder.path(), DatasetFormat::kitti);
    for (std::size_t number = 0; number < 3; ++number) {
      writer.write(simulation.sweep(number));
    }
  }
  const std::vector<std::vector<double>> times = readNumbers(folder.path() / "times.txt");
  const std::array<std::pair<const char*, double>, 3> files{
      {{"poses_start.txt", 0.0}, {"poses_middle.txt", 0.05}, {"poses_end.txt", 0.1}}};
  ASSERT_EQ(times.size(), 3U);
  for (const auto& [name, offset] : files) {
    const std::vector<std::vector<double>> poses = readNumbers(folder.path() / name);
    ASSERT_EQ(poses.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(poses[k].size(), 12U);
      const Eigen::Matrix4d exact = simulation.worldTSensor(times[k][0] + offset).matrix();
      for (Eigen::Index i = 0; i < 12; ++i) {
        EXPECT_NEAR(poses[k][static_cast<std::size_t>(i)], exact(i / 4, i % 4), 1e-10) << name;
      }
    }
  }
}

TEST(DatasetWriter, RefusesAFolderThatHoldsScans)
{
  const test::TemporaryFolder folder;
  Simulation simulation(smallOptions());
  DatasetWriter(folder.path(), DatasetFormat::kitti).write(simulation.sweep(0));
  EXPECT_THROW(DatasetWriter(folder.path(), DatasetFormat::kitti), std::runtime_error);
}

}  // namespace pcl_floam::simulator
