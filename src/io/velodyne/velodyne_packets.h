/// \file velodyne_packets.h
/// Data packets of Velodyne's VLP-16, HDL-32E and HDL-64E (S2, S3), as their manuals have them.
#pragma once

#include "io/velodyne/velodyne_calibration.h"

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_floam {

inline constexpr std::size_t kVelodynePacketBytes = 1206;
inline constexpr std::size_t kVelodyneBlocks = 12;                 ///< of a packet
inline constexpr std::uint64_t kMicrosecondsPerHour = 3600000000;  ///< after which a sensor's time begins anew

enum class VelodyneModel : std::uint8_t { vlp16, hdl32e, hdl64e };

/// A packet, seen but not copied.
class VelodynePacket {
public:
  /// \param bytes kVelodynePacketBytes of them
  explicit VelodynePacket(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint16_t flag(std::size_t block) const { return word(kBlockBytes * block); }
  [[nodiscard]] std::uint16_t azimuth(std::size_t block) const { return word(kBlockBytes * block + 2); }  ///< 0.01 deg
  [[nodiscard]] std::uint16_t distance(std::size_t block, std::size_t i) const  ///< 2 mm; 0: nothing came back
  {
    return word(kBlockBytes * block + 4 + 3 * i);
  }
  [[nodiscard]] std::uint8_t reflectivity(std::size_t block, std::size_t i) const
  {
    return byte(kBlockBytes * block + 6 + 3 * i);
  }
  [[nodiscard]] std::uint32_t microseconds() const  ///< after the hour
  {
    return word(kTail) | (static_cast<std::uint32_t>(word(kTail + 2)) << 16U);
  }
  [[nodiscard]] std::uint8_t returnMode() const { return byte(kTail + 4); }
  [[nodiscard]] std::uint8_t product() const { return byte(kTail + 5); }
  [[nodiscard]] bool isDual() const { return returnMode() == 0x39 && !isHdl64(); }
  /// Of blocks of lasers 0 to 31 and 32 to 63. Its last bytes tell of the sensor's state, in turns.
  [[nodiscard]] bool isHdl64() const;

private:
  static constexpr std::size_t kBlockBytes = 100;
  static constexpr std::size_t kTail = kVelodyneBlocks * kBlockBytes;

  [[nodiscard]] std::uint8_t byte(std::size_t i) const { return static_cast<std::uint8_t>(bytes_[i]); }
  [[nodiscard]] std::uint16_t word(std::size_t i) const
  {
    return static_cast<std::uint16_t>(byte(i) | (static_cast<unsigned>(byte(i + 1)) << 8U));
  }

  std::string_view bytes_;
};

/// Whether these are a data packet of a Velodyne.
[[nodiscard]] bool isVelodynePacket(std::string_view bytes);

/// Tells the model by its blocks and by how long a packet takes: the bytes that should name it do not always do right.
class VelodyneModelFinder {
public:
  void add(const VelodynePacket& packet);
  /// Nothing until some packets were seen.
  [[nodiscard]] std::optional<VelodyneModel> model() const;
  /// What is wrong if it is a model that is not read, or not with this calibration (null: there is none); empty
  /// otherwise.
  [[nodiscard]] std::string problem(const VelodyneCalibration* calibration) const;

private:
  std::vector<std::uint32_t> durations_;  ///< us a packet, of one return each
  std::optional<std::uint32_t> last_;
  std::uint8_t product_ = 0;
  bool is_hdl64_ = false;
};

/// Some blocks of a packet.
struct VelodyneBlocks {
  std::string_view packet;
  std::size_t begin = 0;
  std::size_t end = kVelodyneBlocks;
};

/// Turns packets into points: x forward, y left, z up, in m; intensity; ring from below; time in s.
///
/// Of two returns the last is taken: the first may be dust, rain or a window pane. Of an HDL-64's both are.
class VelodyneCloudBuilder {
public:
  /// \param time_origin s; the time of the first packet in the clouds' field `time`
  /// \param calibration of an HDL-64; null for the others
  VelodyneCloudBuilder(VelodyneModel model, double time_origin, const VelodyneCalibration* calibration,
                       pcl::PCLPointCloud2& cloud);

  void add(const VelodyneBlocks& blocks);
  /// To be called once, after all packets.
  void finish();

private:
  void addHdl64(const VelodynePacket& packet, const VelodyneBlocks& blocks, double time);
  void addBlock(const VelodynePacket& packet, std::size_t block, double time, double turn);
  void addPoint(const LaserPoint& point, double intensity, double time, std::uint16_t ring);

  VelodyneModel model_;
  double time_origin_;
  const VelodyneCalibration* calibration_;
  pcl::PCLPointCloud2& cloud_;
  std::optional<std::uint32_t> first_microseconds_;
  double degrees_per_second_ = 3600.0;  ///< the latest that could be measured
};

}  // namespace pcl_floam
