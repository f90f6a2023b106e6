// Recordings and their messages from files of any bytes.
#include "fuzz/fuzz_input.h"
#include "fuzz/fuzz_targets.h"
#include "support/hdl64_bytes.h"
#include "support/recording_bytes.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace pcl_floam::test {

namespace {

void readAll(const ScanSource& scans)
{
  constexpr std::size_t kMostScans = 64;  // of one trial
  pcl::PCLPointCloud2 cloud;
  for (std::size_t i = 0; i < std::min(scans.size(), kMostScans); ++i) {
    mustHold(!scans.name(i).empty(), "a scan has no name");
    try {
      (void)scans.stamp(i);
      scans.read(i, cloud);
    } catch (const FileError&) {
      continue;
    }
    const CloudView view = viewOf(cloud);  // what a reader lets through must be a cloud
    double sum = 0.0;
    for (std::size_t p = 0; p < view.size; ++p) {
      sum += view.x(p) + view.y(p) + view.z(p);
      sum += view.time.exists() ? view.time.read(view.point(p)) : 0.0;
      sum += view.ring.exists() ? view.ring.read(view.point(p)) : 0.0;
    }
    mustHold(view.size <= cloud.data.size() && (view.size > 0 || sum == 0.0), "points without bytes");
  }
}

void openAndRead(const std::filesystem::path& file)
{
  try {
    const ScanSource scans(file);
    mustHold(scans.size() > 0, "a recording without scans was accepted");
    readAll(scans);
  } catch (const FileError&) {
  }
  try {
    for (const ScanTopic& topic : listTopics(file)) {
      if (topic.has_scans) {
        readAll(ScanSource(file, topic.name));
      }
    }
  } catch (const FileError&) {
  }
}

}  // namespace

void fuzzRecording(const std::uint8_t* bytes, std::size_t size)
{
  static const TemporaryFolder folder;
  openAndRead(writeInput(folder, "recording", bytes, size));
}

void fuzzScanMessage(const std::uint8_t* bytes, std::size_t size)
{
  static const TemporaryFolder folder;
  constexpr const char* kTypes[] = {"sensor_msgs/PointCloud2", "livox_ros_driver2/CustomMsg",
                                    "velodyne_msgs/VelodyneScan"};
  if (size == 0) {
    return;
  }
  const std::string message(reinterpret_cast<const char*>(bytes) + 1, size - 1);
  const std::string encoding = bytes[0] % 2 == 0 ? "ros1" : "cdr";
  openAndRead(folder.write("message.mcap", mcapFile(kTypes[bytes[0] / 2 % 3], encoding, {message})));
}

void fuzzCalibration(const std::uint8_t* bytes, std::size_t size)
{
  static const TemporaryFolder folder;
  static std::vector<Hdl64Return> returns;
  static const std::filesystem::path capture = folder.write("hdl64.pcap", hdl64Capture({6.0, 9.0}, 4, returns));
  const std::filesystem::path calibration = writeInput(folder, "calibration", bytes, size);
  try {
    (void)isLaserCalibration(calibration);
    const ScanSource scans(capture, ScanSourceOptions{"", calibration});
    pcl::PCLPointCloud2 cloud;
    scans.read(0, cloud);
    const CloudView view = viewOf(cloud);
    mustHold(view.size == returns.size(), "a calibration that takes points away");
    for (std::size_t i = 0; i < view.size; ++i) {
      constexpr float kFarthest = 2000.0F;  // m; 65535 units of the coarsest, and corrections
      mustHold(std::abs(view.x(i)) + std::abs(view.y(i)) + std::abs(view.z(i)) < kFarthest, "a point that is nowhere");
      mustHold(view.ring.read(view.point(i)) < 64.0, "a ring that is none");
    }
  } catch (const FileError&) {
  }
}

}  // namespace pcl_floam::test
