// Packets of a Velodyne HDL-64, which need the calibration of their sensor.
#include "support/hdl64_bytes.h"
#include "support/temporary_folder.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <set>

namespace pcl_floam::test {
namespace {

constexpr int kPacketsOfTurn = 348;  // the last goes over into the next turn

class Hdl64 : public ::testing::Test {
protected:
  void SetUp() override
  {
    xml = folder.write("db.xml", hdl64Xml());
    yaml = folder.write("64e.yaml", hdl64Yaml());
    for (const auto& input : {xml, yaml}) {
      const std::string told = problem(CaptureBytes().bytes(), input);
      if (told.find("left out") != std::string::npos) {
        GTEST_SKIP() << "SKIPPED: " << told;
      }
    }
  }
  [[nodiscard]] std::string problem(const std::string& capture, const std::filesystem::path& calibration) const
  {
    try {
      const ScanSource scans(folder.write("a.pcap", capture), ScanSourceOptions{"", calibration});
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::string problemOf(const std::string& calibration) const
  {
    const std::string told = problem(hdl64Capture({}, 20, unused_), folder.write("calibration", calibration));
    EXPECT_NE(told.find((folder.path() / "calibration").string()), std::string::npos) << told;
    return told;
  }
  [[nodiscard]] pcl::PCLPointCloud2 firstTurn(const std::string& capture,
                                              const std::filesystem::path& calibration) const
  {
    const ScanSource scans(folder.write("a.pcap", capture), ScanSourceOptions{"", calibration});
    EXPECT_EQ(scans.size(), 2U);
    pcl::PCLPointCloud2 cloud;
    scans.read(0, cloud);
    return cloud;
  }
  TemporaryFolder folder;
  std::filesystem::path xml;
  std::filesystem::path yaml;
  mutable std::vector<Hdl64Return> unused_;
};

TEST_F(Hdl64, FarPointsLieWhereTheLasersHitTheWalls)
{
  std::vector<Hdl64Return> returns;
  const std::string capture = hdl64Capture({}, 2 * kPacketsOfTurn, returns);
  for (const auto& calibration : {xml, yaml}) {
    const pcl::PCLPointCloud2 cloud = firstTurn(capture, calibration);
    const CloudView view = viewOf(cloud);
    ASSERT_NEAR(static_cast<double>(view.size), 64 * 0.1 / 48e-6, 64.0);
    std::set<double> rings;
    for (std::size_t i = 0; i < view.size; ++i) {
      const Eigen::Vector3d found(-view.y(i), view.x(i), view.z(i));
      ASSERT_LT((found - returns[i].point).norm(), 0.0015) << i << ": " << found.transpose();
      ASSERT_NEAR(view.time.read(view.point(i)), 48e-6 * std::floor(static_cast<double>(i) / 64.0), 2e-6) << i;
      EXPECT_EQ(view.intensity.read(view.point(i)), 55.0);
      rings.insert(view.ring.read(view.point(i)));
    }
    EXPECT_EQ(rings.size(), 64U);
    EXPECT_EQ(view.ring.read(view.point(0)), 63.0) << "laser 0 looks up the most";
    EXPECT_EQ(view.ring.read(view.point(63)), 0.0);
  }
}

TEST_F(Hdl64, NearByTheCorrectionsOfBothCoordinatesAreInterpolated)
{
  const Hdl64Room room{6.0, 9.0};
  std::vector<Hdl64Return> returns;
  const std::string capture = hdl64Capture(room, 2 * kPacketsOfTurn, returns);
  for (const auto& calibration : {xml, yaml}) {
    const pcl::PCLPointCloud2 cloud = firstTurn(capture, calibration);
    const CloudView view = viewOf(cloud);
    for (std::size_t i = 0; i < view.size; ++i) {
      const Eigen::Vector3d found(-view.y(i), view.x(i), view.z(i));
      const int wall = returns[i].wall;
      ASSERT_NEAR(found[wall], returns[i].point[wall], 0.0015) << i << " " << found.transpose();
      if (wall == 1) {  // the height goes with the distance to the front
        ASSERT_NEAR(found.z(), returns[i].point.z(), 0.0015) << i;
      }
    }
  }
}

TEST_F(Hdl64, WithoutTwoNearDistancesTheFarOneHoldsEverywhere)
{
  std::string one_point = hdl64Yaml();
  for (std::size_t i = one_point.find("focal"); i != std::string::npos; i = one_point.find("focal", i + 40)) {
    one_point.insert(i, "two_pt_correction_available: false, ");
  }
  const Hdl64Room room{6.0, 9.0};
  std::vector<Hdl64Return> returns;
  const std::string capture = hdl64Capture(room, 2 * kPacketsOfTurn, returns);
  const pcl::PCLPointCloud2 one = firstTurn(capture, folder.write("one.yaml", one_point));
  const pcl::PCLPointCloud2 two = firstTurn(capture, yaml);
  const CloudView view = viewOf(one);
  double worst = 0.0;
  for (std::size_t i = 0; i < view.size; ++i) {
    worst = std::max(worst, std::abs(static_cast<double>(view.x(i)) - viewOf(two).x(i)));
  }
  EXPECT_GT(worst, 0.02);
  EXPECT_LT(worst, 0.1);
}

TEST_F(Hdl64, MessagesOfPacketsAreDecodedAlike)
{
  std::vector<Hdl64Return> returns;
  MessageBytes message(true);
  message.header(1700000000, 0).number(std::uint32_t{100});
  for (int i = 0; i < 100; ++i) {
    message.number(std::uint32_t{1700000000}).number(static_cast<std::uint32_t>(288000 * i));
    message.raw(hdl64Packet({}, i, returns));
  }
  const auto file = folder.write("0.mcap", mcapFile("velodyne_msgs/msg/VelodyneScan", "cdr", {message.bytes()}));
  pcl::PCLPointCloud2 cloud;
  ScanSource(file, ScanSourceOptions{"", xml}).read(0, cloud);
  const CloudView view = viewOf(cloud);
  ASSERT_EQ(view.size, returns.size());
  for (std::size_t i = 0; i < view.size; ++i) {
    ASSERT_LT((Eigen::Vector3d(-view.y(i), view.x(i), view.z(i)) - returns[i].point).norm(), 0.0015);
  }
  try {
    ScanSource(file).read(0, cloud);
    ADD_FAILURE() << "without its calibration";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("HDL-64"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("--calibration"), std::string::npos) << error.what();
  }
}

TEST_F(Hdl64, ACalibrationThatIsNoneOrNotWholeIsRefused)
{
  EXPECT_NE(problemOf("P0: 1 0 0 0\n").find("is no calibration"), std::string::npos);
  EXPECT_NE(problemOf("").find("is no calibration"), std::string::npos);
  EXPECT_NE(problemOf("<DB>\n<points_>").find("line 2: is no XML"), std::string::npos);
  EXPECT_NE(problemOf("<a/>").find("has no lasers"), std::string::npos);
  EXPECT_NE(problemOf("lasers: [1, {").find("line 1: is no YAML"), std::string::npos);
  EXPECT_NE(problemOf("lasers: 3\n").find("has no list of lasers"), std::string::npos);
  EXPECT_NE(problemOf("lasers:\n- 3\n").find("line 2: the entry"), std::string::npos);
  EXPECT_NE(problemOf(hdl64Xml(63)).find("has corrections of 63 lasers"), std::string::npos);
  std::string broken = hdl64Xml();
  broken.replace(broken.find("-8.83"), 5, "-8,83");
  EXPECT_NE(problemOf(broken).find("vertCorrection_ of laser 32: ' -8,83 ' is no number"), std::string::npos);
  broken = hdl64Yaml();
  broken.replace(broken.find("vert_correction: 0.03"), 21, "vert_correction: 2.03");  // degrees where rad are meant
  EXPECT_NE(problemOf(broken).find("vert_correction of laser 0"), std::string::npos);
  broken = hdl64Yaml();
  broken.replace(broken.find("0.002"), 5, "0.200");
  EXPECT_NE(problemOf(broken).find("units of 0.2"), std::string::npos);
  EXPECT_NE(problemOf(std::string(std::size_t{1} << 21U, '<')).find("too large"), std::string::npos);
  EXPECT_NE(problem(hdl64Capture({}, 20, unused_), folder.path() / "missing").find("missing"), std::string::npos);
}

TEST_F(Hdl64, ACalibrationIsAskedForAndRefusedWhereItIsOfNoUse)
{
  const std::string told = problem(hdl64Capture({}, 20, unused_), "");
  EXPECT_NE(told.find("HDL-64"), std::string::npos) << told;
  EXPECT_NE(told.find("--calibration"), std::string::npos) << told;
  EXPECT_NE(problem(velodyneCapture({}, 0.2), xml).find("leave --calibration out"), std::string::npos);
  folder.write("scans/0.bin", std::string(16, '\0'));
  EXPECT_THROW(ScanSource(folder.path() / "scans", ScanSourceOptions{"", xml}), FileError);
  const auto cloud = folder.write("1.mcap", mcapFile("sensor_msgs/msg/PointCloud2", "cdr", {pointCloud2({})}));
  EXPECT_THROW(ScanSource(cloud, ScanSourceOptions{"", xml}), FileError);
  EXPECT_EQ(listTopics(folder.path() / "a.pcap").size(), 1U);
}

TEST_F(Hdl64, TheKindOfACalibrationIsTold)
{
  EXPECT_TRUE(isLaserCalibration(xml));
  EXPECT_TRUE(isLaserCalibration(yaml));
  EXPECT_FALSE(isLaserCalibration(folder.write("calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 1\n")));
  EXPECT_THROW((void)isLaserCalibration(folder.path() / "missing"), FileError);
}

}  // namespace
}  // namespace pcl_floam::test
