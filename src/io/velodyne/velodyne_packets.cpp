#include "io/velodyne/velodyne_packets.h"

#include "common/median.h"
#include "common/pi.h"
#include "io/messages/scan_messages.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pcl_floam {

namespace {

constexpr std::uint16_t kBlockFlag = 0xEEFF;
constexpr std::uint16_t kLowerBlockFlag = 0xDDFF;  ///< HDL-64: lasers 32 to 63
constexpr std::size_t kReturns = 32;               ///< of a block
constexpr double kDistanceUnit = 0.002;            ///< m
constexpr int kHundredths = 36000;                 ///< of a degree in a turn

/// How a model fires.
struct Firing {
  std::size_t lasers;
  std::size_t per_block;  ///< how often all of them fire in a block
  double laser_period;    ///< s from laser to laser
  double firing_period;   ///< s from all lasers to all lasers again
};

constexpr Firing kVlp16{16, 2, 2.304e-6, 55.296e-6};
constexpr Firing kHdl32{32, 1, 1.152e-6, 46.08e-6};

constexpr const Firing& firingOf(VelodyneModel model)
{
  return model == VelodyneModel::vlp16 ? kVlp16 : kHdl32;
}

/// A laser's place.
struct Laser {
  double elevation = 0.0;  ///< rad
  double height = 0.0;     ///< m; where it leaves, above the sensor's middle
  std::uint16_t ring = 0;
};

std::array<Laser, 16> vlp16Lasers()
{
  constexpr std::array<double, 16> kDegrees{-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  constexpr std::array<double, 16> kMillimetres{11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                                5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
  std::array<Laser, 16> lasers;
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    lasers[i] = {kDegrees[i] * kPi / 180.0, 1e-3 * kMillimetres[i],
                 static_cast<std::uint16_t>(std::lround((kDegrees[i] + 15.0) / 2.0))};
  }
  return lasers;
}

std::array<Laser, 32> hdl32Lasers()
{
  // Lasers fire alternately from the lower and the upper half, 4/3 degrees apart in each.
  std::array<Laser, 32> lasers;
  constexpr double kLowest = -92.0 / 3.0;  // degrees
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    const std::size_t ring = i / 2 + (i % 2 == 0 ? 0 : 16);
    lasers[i] = {(kLowest + 4.0 / 3.0 * static_cast<double>(ring)) * kPi / 180.0, 0.0,
                 static_cast<std::uint16_t>(ring)};
  }
  return lasers;
}

const Laser& laserOf(VelodyneModel model, std::size_t i)
{
  static const std::array<Laser, 16> vlp16 = vlp16Lasers();
  static const std::array<Laser, 32> hdl32 = hdl32Lasers();
  return model == VelodyneModel::vlp16 ? vlp16[i % vlp16.size()] : hdl32[i];
}

/// Cosine and sine of a hundredth of a degree.
struct Direction {
  float cosine;
  float sine;
};

const std::vector<Direction>& directions()
{
  static const std::vector<Direction> table = [] {
    std::vector<Direction> all;
    for (int i = 0; i < kHundredths; ++i) {
      const double angle = i * kPi / (0.5 * kHundredths);
      all.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
    }
    return all;
  }();
  return table;
}

/// Hundredths of a degree from one block to a later one.
int turned(const VelodynePacket& packet, std::size_t from, std::size_t to)
{
  return (packet.azimuth(to) - packet.azimuth(from) + kHundredths) % kHundredths;
}

struct CloudPoint {
  float x, y, z, intensity, time;
  std::uint16_t ring;
};

constexpr std::uint32_t kVelodynePointBytes = 22;

}  // namespace

bool isVelodynePacket(std::string_view bytes)
{
  if (bytes.size() != kVelodynePacketBytes) {
    return false;
  }
  const VelodynePacket packet(bytes);
  for (std::size_t block = 0; block < kVelodyneBlocks; ++block) {
    if (packet.flag(block) != kBlockFlag && packet.flag(block) != kLowerBlockFlag) {
      return false;
    }
  }
  return true;
}

bool VelodynePacket::isHdl64() const
{
  for (std::size_t block = 0; block < kVelodyneBlocks; ++block) {
    if (flag(block) == kLowerBlockFlag) {
      return true;
    }
  }
  return false;
}

void VelodyneModelFinder::add(const VelodynePacket& packet)
{
  constexpr std::size_t kEnough = 256;
  is_hdl64_ |= packet.isHdl64();
  product_ = packet.product();
  if (last_ && packet.microseconds() > *last_ && durations_.size() < kEnough) {
    durations_.push_back((packet.microseconds() - *last_) * (packet.isDual() ? 2U : 1U));
  }
  last_ = packet.microseconds();
}

std::optional<VelodyneModel> VelodyneModelFinder::model() const
{
  if (is_hdl64_) {
    return VelodyneModel::hdl64e;
  }
  constexpr std::size_t kFew = 8;
  if (durations_.size() < kFew) {
    return std::nullopt;
  }
  // Lost packets make some longer: the median is that of the model.
  std::vector<std::uint32_t> sorted = durations_;
  constexpr std::uint32_t kBetweenModels = 900;  // us; the models take 1327 and 553
  return medianOf(sorted) > kBetweenModels ? VelodyneModel::vlp16 : VelodyneModel::hdl32e;
}

std::string VelodyneModelFinder::problem(const VelodyneCalibration* calibration) const
{
  if (is_hdl64_) {
    return calibration != nullptr ? ""
                                  : "is of a Velodyne HDL-64, whose points need its sensor's own calibration: name its "
                                    "db.xml, or the YAML made of it, with --calibration (or ScanSourceOptions)";
  }
  if (calibration != nullptr) {
    return "is not of a Velodyne HDL-64, the only model that needs a calibration: leave --calibration out";
  }
  constexpr std::uint8_t kVlp32 = 0x28;
  constexpr std::uint8_t kVls128 = 0xA1;
  if (product_ == kVlp32 || product_ == kVls128) {
    return std::string("is of a Velodyne ") + (product_ == kVlp32 ? "VLP-32C" : "VLS-128") +
           ", which is not read: convert it to point clouds with its driver";
  }
  return "";
}

VelodyneCloudBuilder::VelodyneCloudBuilder(VelodyneModel model, double time_origin,
                                           const VelodyneCalibration* calibration, pcl::PCLPointCloud2& cloud)
    : model_(model), time_origin_(time_origin), calibration_(calibration), cloud_(cloud)
{
  using pcl::PCLPointField;
  cloud.fields.clear();
  cloud.data.clear();
  cloud.point_step = 0;
  for (const char* name : {"x", "y", "z", "intensity", "time"}) {
    addField(cloud, name, PCLPointField::FLOAT32, sizeof(float));
  }
  addField(cloud, "ring", PCLPointField::UINT16, sizeof(std::uint16_t));
}

void VelodyneCloudBuilder::add(const VelodyneBlocks& blocks)
{
  const VelodynePacket packet(blocks.packet);
  const std::uint32_t microseconds = packet.microseconds();
  first_microseconds_ = first_microseconds_.value_or(microseconds);
  const std::int64_t since = (static_cast<std::int64_t>(microseconds) - *first_microseconds_ +
                              static_cast<std::int64_t>(kMicrosecondsPerHour)) %
                             static_cast<std::int64_t>(kMicrosecondsPerHour);
  const double packet_time = time_origin_ + 1e-6 * static_cast<double>(since);
  if (model_ == VelodyneModel::hdl64e) {
    addHdl64(packet, blocks, packet_time);
    return;
  }
  const Firing& firing = firingOf(model_);
  const double block_period = firing.firing_period * static_cast<double>(firing.per_block);
  const std::size_t step = packet.isDual() ? 2 : 1;
  const int turn = turned(packet, 0, kVelodyneBlocks - step);
  const std::size_t steps = kVelodyneBlocks / step - 1;
  constexpr int kFastest = 1500;  // a packet turns less, at 20 turns a second: else blocks are missing
  if (turn > 0 && turn < kFastest) {
    degrees_per_second_ = 0.01 * turn / (static_cast<double>(steps) * block_period);
  }
  // Of each pair of blocks with two returns, the first holds the last return.
  for (std::size_t block = blocks.begin - blocks.begin % step; block < blocks.end; block += step) {
    const std::size_t fired = block / step;
    addBlock(packet, block, packet_time + static_cast<double>(fired) * block_period, degrees_per_second_);
  }
}

/// All lasers of a firing are given its time and azimuth, as the makers' calibration takes them: within the 48 us until
/// the next a car drives 1.5 mm.
void VelodyneCloudBuilder::addHdl64(const VelodynePacket& packet, const VelodyneBlocks& blocks, double time)
{
  constexpr double kFiringPeriod = 48e-6;      // s; 3472 packets a second of six firings
  constexpr std::size_t kBlocksPerFiring = 2;  // upper and lower lasers
  constexpr double kRadians = kPi / (0.5 * kHundredths);
  for (std::size_t block = blocks.begin; block < blocks.end; ++block) {
    const std::size_t first = packet.flag(block) == kLowerBlockFlag ? kReturns : 0;
    const std::size_t firing = block / kBlocksPerFiring;
    const double fired = time + kFiringPeriod * static_cast<double>(firing);
    for (std::size_t i = 0; i < kReturns && packet.azimuth(block) < kHundredths; ++i) {
      if (packet.distance(block, i) != 0) {
        const LaserCorrection& laser = calibration_->lasers[first + i];
        const double distance = calibration_->distance_unit * packet.distance(block, i);
        addPoint(calibratedPoint(laser, kRadians * packet.azimuth(block), distance), packet.reflectivity(block, i),
                 fired, laser.ring);
      }
    }
  }
}

void VelodyneCloudBuilder::addPoint(const LaserPoint& point, double intensity, double time, std::uint16_t ring)
{
  const CloudPoint bytes_of{static_cast<float>(point.x),   static_cast<float>(point.y), static_cast<float>(point.z),
                            static_cast<float>(intensity), static_cast<float>(time),    ring};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&bytes_of);
  cloud_.data.insert(cloud_.data.end(), bytes, bytes + kVelodynePointBytes);
}

void VelodyneCloudBuilder::addBlock(const VelodynePacket& packet, std::size_t block, double time, double turn)
{
  const Firing& firing = firingOf(model_);
  if (packet.azimuth(block) >= kHundredths) {
    return;
  }
  for (std::size_t i = 0; i < kReturns; ++i) {
    if (packet.distance(block, i) == 0) {
      continue;
    }
    const Laser& laser = laserOf(model_, i);
    const std::size_t before = i / firing.lasers;  // firings of all lasers in this block
    const double delay = static_cast<double>(before) * firing.firing_period +
                         static_cast<double>(i % firing.lasers) * firing.laser_period;
    const long azimuth = packet.azimuth(block) + std::lround(100.0 * turn * delay);
    const Direction& direction = directions()[static_cast<std::size_t>(azimuth % kHundredths)];
    const double range = kDistanceUnit * packet.distance(block, i);
    const double flat = range * std::cos(laser.elevation);
    // Velodyne's azimuth turns clockwise from its forward axis.
    addPoint({flat * static_cast<double>(direction.cosine), -flat * static_cast<double>(direction.sine),
              range * std::sin(laser.elevation) + laser.height},
             packet.reflectivity(block, i), time + delay, laser.ring);
  }
}

void VelodyneCloudBuilder::finish()
{
  cloud_.height = 1;
  cloud_.width = static_cast<std::uint32_t>(cloud_.data.size() / kVelodynePointBytes);
  cloud_.row_step = cloud_.width * kVelodynePointBytes;
  cloud_.is_bigendian = 0;
  cloud_.is_dense = 1;
}

}  // namespace pcl_floam
