// Packets of Velodyne's sensors, captured or recorded as messages.
#include "support/constants.h"
#include "support/temporary_folder.h"
#include "support/velodyne_bytes.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <gtest/gtest.h>

#include <set>

namespace pcl_floam::test {
namespace {

/// Every point on the round wall, on the ring of its elevation, at the time at which the head looked there.
void expectRoundWall(const pcl::PCLPointCloud2& cloud, const VelodyneSetting& s, double first_time = 0.0)
{
  const CloudView view = viewOf(cloud);
  std::set<int> rings;
  const double firings = 1.0 / (s.turns_per_second * (s.hdl32 ? 46.08e-6 : 55.296e-6));
  EXPECT_NEAR(static_cast<double>(view.size), firings * (s.hdl32 ? 32 : 16), 0.01 * firings * 16);
  for (std::size_t i = 0; i < view.size; ++i) {
    const double x = view.x(i);
    const double y = view.y(i);
    const double z = view.z(i);
    ASSERT_NEAR(std::sqrt(x * x + y * y + z * z), s.range, 0.013);
    const int ring = static_cast<int>(view.ring.read(view.point(i)));
    const double elevation = s.hdl32 ? -92.0 / 3.0 + 4.0 / 3.0 * ring : -15.0 + 2.0 * ring;
    ASSERT_NEAR(std::atan2(z, std::hypot(x, y)) * 180.0 / kPi, elevation, 0.08);
    rings.insert(ring);
    const double time = view.time.read(view.point(i)) - first_time;
    const double turned = std::fmod(-std::atan2(y, x) / (2.0 * kPi) + 2.0, 1.0);
    const double expected = std::fmod(s.turns_per_second * time + s.first_degrees / 360.0, 1.0);
    ASSERT_LT(std::abs(std::remainder(turned - expected, 1.0)), 0.02) << "time " << time;
  }
  EXPECT_EQ(rings.size(), s.hdl32 ? 32U : 16U);
}

class Captures : public ::testing::Test {
protected:
  void SetUp() override
  {
    try {
      (void)listTopics(folder.write("empty.pcap", CaptureBytes().bytes()));
    } catch (const FileError& error) {
      GTEST_SKIP() << "SKIPPED: " << error.what();
    }
  }
  void expectTurns(const VelodyneSetting& setting, std::size_t turns) const
  {
    const ScanSource scans(folder.write("a.pcap", velodyneCapture(setting, 0.5)));
    ASSERT_EQ(scans.size(), turns);
    pcl::PCLPointCloud2 cloud;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      scans.read(i, cloud);
      SCOPED_TRACE(i);
      const double late = scans.stamp(i).value() - 1.7e9 - static_cast<double>(i) / setting.turns_per_second;
      EXPECT_LT(std::abs(late), 0.002);
      // Times begin with the packet in which the turn begins.
      expectRoundWall(cloud, setting, -late);
    }
    scans.read(0, cloud);
    expectRoundWall(cloud, setting);
  }
  [[nodiscard]] std::string problem(const std::string& content, const std::string& topic = "") const
  {
    try {
      const ScanSource scans(folder.write("bad.pcap", content), topic);
      pcl::PCLPointCloud2 cloud;
      for (std::size_t i = 0; i < scans.size(); ++i) {
        scans.read(i, cloud);
      }
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  }
  TemporaryFolder folder;
};

TEST_F(Captures, AVlp16TurnsTenAndTwentyTimesASecond)
{
  VelodyneSetting setting;
  expectTurns(setting, 5);
  setting.turns_per_second = 20.0;
  expectTurns(setting, 10);
}

TEST_F(Captures, EachLaserHasItsOwnTime)
{
  for (const bool hdl32 : {false, true}) {
    VelodyneSetting setting;
    setting.hdl32 = hdl32;
    const ScanSource scans(folder.write("a.pcap", velodyneCapture(setting, 0.15)));
    pcl::PCLPointCloud2 cloud;
    scans.read(0, cloud);
    const CloudView view = viewOf(cloud);
    for (std::size_t i = 0; i < 64; ++i) {  // of the manuals: from laser to laser, and until all fire again
      const double expected = hdl32 ? 1.152e-6 * static_cast<double>(i % 32) + (i < 32 ? 0.0 : 46.08e-6)
                                    : 2.304e-6 * static_cast<double>(i % 16) + 55.296e-6 * std::floor(i / 16.0);
      EXPECT_NEAR(view.time.read(view.point(i)), expected, 1e-9) << i;
    }
  }
}

TEST_F(Captures, TheModelIsToldByThePacketsRateNotByTheirProductByte)
{
  VelodyneSetting setting;
  setting.product = 0x21;  // HDL-32E, it says
  expectTurns(setting, 5);
  setting.hdl32 = true;
  setting.product = 0x22;
  expectTurns(setting, 5);
}

TEST_F(Captures, OfTwoReturnsTheLastIsTaken)
{
  VelodyneSetting setting;
  setting.dual = true;
  expectTurns(setting, 5);
  setting.hdl32 = true;
  expectTurns(setting, 5);
}

TEST_F(Captures, FramesOfOtherLinksAndClocksAreUnderstood)
{
  const VelodyneSetting setting;
  const std::string cooked = std::string(14, '\0') + networkBytes(std::uint16_t{0x0800});
  const std::string vlan =
      std::string(12, '\1') + networkBytes(std::uint32_t{0x81000005U}) + networkBytes(std::uint16_t{0x0800});
  CaptureBytes of_cooked(113, true);
  // Linux cooked 2: protocol first, then 18 bytes of interface and address.
  const std::string cooked2 = networkBytes(std::uint16_t{0x0800}) + std::string(18, '\2');
  CaptureBytes of_cooked2(276);
  CaptureBytes of_nanoseconds(1, true);
  CaptureBytes of_vlan;
  CaptureBytes of_ip(101);
  for (int i = 0; i < 160; ++i) {
    const double time = 1.7e9 + i * setting.packetPeriod();
    const std::string ip = udp(velodynePacket(setting, i));
    of_cooked.packet(time, cooked + ip);
    of_cooked2.packet(time, cooked2 + ip);
    of_nanoseconds.packet(time, ethernet(ip));
    of_vlan.packet(time, vlan + ip);
    of_ip.packet(time, ip);
  }
  for (const CaptureBytes* capture : {&of_cooked, &of_cooked2, &of_nanoseconds, &of_vlan, &of_ip}) {
    const ScanSource scans(folder.write("b.pcap", capture->bytes()));
    ASSERT_EQ(scans.size(), 2U);
    pcl::PCLPointCloud2 cloud;
    scans.read(0, cloud);
    expectRoundWall(cloud, setting);
    EXPECT_NEAR(scans.stamp(1).value(), 1.7e9 + 0.1, 0.002);
  }
}

TEST_F(Captures, NewerCapturesAreReadWithEitherClock)
{
  const VelodyneSetting setting;
  for (const bool nanoseconds : {false, true}) {
    NewCaptureBytes capture(nanoseconds);
    for (int i = 0; i < 160; ++i) {
      capture.packet(1.7e9 + i * setting.packetPeriod(), ethernet(udp(velodynePacket(setting, i))));
      if (i % 10 == 0) {
        capture.block(5, std::string(12, '\1'));  // the interface's statistics
      }
    }
    const auto file = folder.write("b.pcapng", capture.bytes());
    const ScanSource scans(file);
    ASSERT_EQ(scans.size(), 2U);
    EXPECT_EQ(scans.format(), ScanFormat::pcap);
    pcl::PCLPointCloud2 cloud;
    for (const std::size_t i : {1U, 0U, 1U}) {  // back and forth
      scans.read(i, cloud);
      const double late = scans.stamp(i).value() - 1.7e9 - 0.1 * static_cast<double>(i);
      EXPECT_LT(std::abs(late), 0.002);
      expectRoundWall(cloud, setting, -late);
    }
    const std::string& whole = capture.bytes();
    const std::string told = problem(whole.substr(0, whole.size() - 700));
    EXPECT_NE(told.find("cut off"), std::string::npos) << told;
  }
}

TEST_F(Captures, OtherPacketsAreOverlookedAndSeveralLidarsToldApart)
{
  const VelodyneSetting setting;
  CaptureBytes capture;
  for (int i = 0; i < 160; ++i) {
    const double time = 1.7e9 + i * setting.packetPeriod();
    capture.packet(time, ethernet(udp(velodynePacket(setting, i))));
    capture.packet(time, ethernet(udp(std::string(512, '\0'), 201, 8308)));
    capture.packet(time, std::string(60, '\7'));
    capture.packet(time, ethernet(udp(velodynePacket(setting, i), 202, 2369)));
  }
  EXPECT_NE(problem(capture.bytes()).find("192.168.1.201:2368, 192.168.1.202:2369"), std::string::npos);
  EXPECT_EQ(problem(capture.bytes(), "192.168.1.202:2369"), "");
  EXPECT_EQ(listTopics(folder.write("c.pcap", capture.bytes())).size(), 2U);
}

TEST_F(Captures, WhatIsNotReadIsRefusedByName)
{
  CaptureBytes hesai;
  CaptureBytes hdl64;
  std::string lower = velodynePacket({}, 0);
  lower.replace(100, 2, bytesOf(std::uint16_t{0xDDFF}));
  for (int i = 0; i < 20; ++i) {
    hesai.packet(1.0, ethernet(udp("\xEE\xFF" + std::string(800, '\0'))));
    hdl64.packet(1.0, ethernet(udp(lower)));
  }
  EXPECT_NE(problem(hesai.bytes()).find("Hesai"), std::string::npos);
  EXPECT_NE(problem(hdl64.bytes()).find("HDL-64"), std::string::npos);
  VelodyneSetting vlp32;
  vlp32.product = 0x28;
  EXPECT_NE(problem(velodyneCapture(vlp32, 0.1)).find("VLP-32C"), std::string::npos);
  EXPECT_NE(problem(CaptureBytes().bytes()).find("no data packets"), std::string::npos);
}

TEST_F(Captures, CutOffTheyGiveTheTurnsBeforeAndThenTheReason)
{
  const std::string whole = velodyneCapture({}, 0.5);
  const ScanSource scans(folder.write("cut.pcap", whole.substr(0, whole.size() - 100)));
  ASSERT_GE(scans.size(), 5U);
  pcl::PCLPointCloud2 cloud;
  scans.read(3, cloud);
  expectRoundWall(cloud, {}, 0.3 - (scans.stamp(3).value() - 1.7e9));
  EXPECT_THROW(scans.read(scans.size() - 1, cloud), FileError);
}

TEST(VelodyneScans, MessagesOfPacketsAreDecodedAlike)
{
  const TemporaryFolder folder;
  const VelodyneSetting setting;
  for (const bool cdr : {false, true}) {
    MessageBytes message(cdr);
    message.header(1700000000, 100000000).number(std::uint32_t{75});
    for (int i = 0; i < 75; ++i) {
      message.number(std::uint32_t{1700000000}).number(static_cast<std::uint32_t>(1e9 * i * setting.packetPeriod()));
      message.raw(velodynePacket(setting, i));
    }
    const std::string type = cdr ? "velodyne_msgs/msg/VelodyneScan" : "velodyne_msgs/VelodyneScan";
    const ScanSource scans(folder.write("0.mcap", mcapFile(type, cdr ? "cdr" : "ros1", {message.bytes()})));
    ASSERT_EQ(scans.size(), 1U);
    pcl::PCLPointCloud2 cloud;
    scans.read(0, cloud);
    EXPECT_EQ(scans.stamp(0), 1700000000.1);
    // The driver stamps the turn's end: times are negative.
    expectRoundWall(cloud, setting, -0.1);
  }
}

}  // namespace
}  // namespace pcl_floam::test
