#include "io/velodyne/pcap_scans.h"

#include "io/velodyne/udp_packets.h"
#include "io/velodyne/velodyne_packets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace pcl_floam {

namespace {

constexpr int kHalfTurn = 18000;  ///< 0.01 deg

/// Where a turn of the head begins.
struct Turn {
  std::int64_t place = 0;  ///< of the packet in the file
  std::uint64_t number = 0;
  std::size_t block = 0;  ///< of that packet
  double stamp = 0.0;     ///< s; of that packet
};

/// What one sender sent.
class Sender {
public:
  void add(const Datagram& datagram)
  {
    const VelodynePacket packet(datagram.data);
    finder.add(packet);
    addTime(packet, datagram.time);
    for (std::size_t block = 0; block < kVelodyneBlocks; ++block) {
      const int azimuth = packet.azimuth(block);
      if (turns_.empty() || azimuth < azimuth_ - kHalfTurn) {
        starts_whole_ |= turns_.empty() && azimuth < kHalfTurn;
        turns_.push_back({datagram.place, datagram.number, block, stamp_});
      }
      azimuth_ = azimuth;
    }
  }

  /// Where turns begin, and where the last ends. Of a turn at the capture's beginning or end that is less than half,
  /// nothing is told.
  [[nodiscard]] std::vector<Turn> turns() const
  {
    std::vector<Turn> turns = turns_;
    if (!starts_whole_ && turns.size() > 1) {
      turns.erase(turns.begin());
    }
    constexpr std::int64_t kNowhere = -1;
    if (azimuth_ >= kHalfTurn || turns.size() < 2) {
      turns.push_back({kNowhere, 0, 0, 0.0});
    }
    return turns;
  }

  VelodyneModelFinder finder;

private:
  /// By the sensor's clock, which begins anew every hour: the computer's tells which hour it is, and the first time.
  void addTime(const VelodynePacket& packet, double captured)
  {
    if (turns_.empty()) {
      stamp_ = captured;
    } else {
      constexpr double kHour = 3600.0;
      const double since = 1e-6 * (static_cast<double>(packet.microseconds()) - static_cast<double>(microseconds_));
      stamp_ += since + kHour * std::round((captured - captured_ - since) / kHour);
    }
    microseconds_ = packet.microseconds();
    captured_ = captured;
  }

  std::vector<Turn> turns_;
  bool starts_whole_ = false;
  int azimuth_ = 0;
  std::uint32_t microseconds_ = 0;
  double captured_ = 0.0;
  double stamp_ = 0.0;
};

/// Which other lidar's packet it is, as far as its first bytes and its length tell.
std::string otherLidar(std::string_view data)
{
  const auto begins = [data](std::string_view magic) { return data.substr(0, magic.size()) == magic; };
  constexpr std::size_t kOusterSizes[] = {3392, 6464, 8448, 12608, 16640, 24832, 24896, 33024};
  if (begins("\xEE\xFF")) {
    return "Hesai";
  }
  if (begins("\x55\xAA\x05\x0A") || begins("\x55\xAA\x05\x5A")) {
    return "RoboSense";
  }
  return std::find(std::begin(kOusterSizes), std::end(kOusterSizes), data.size()) != std::end(kOusterSizes) ? "Ouster"
                                                                                                            : "";
}

/// All that a capture holds.
struct Survey {
  explicit Survey(const std::filesystem::path& file)
  {
    UdpPackets packets(file);
    Datagram datagram;
    try {
      while (packets.next(datagram)) {
        take(datagram);
      }
    } catch (const FileError& error) {
      damage = error;
    }
  }

  void take(const Datagram& datagram)
  {
    ++datagrams;
    if (!isVelodynePacket(datagram.data)) {
      other = other.empty() ? otherLidar(datagram.data) : other;
      return;
    }
    senders[datagram.sender].add(datagram);
  }

  std::map<std::string, Sender> senders;
  std::uint64_t datagrams = 0;
  std::string other;
  std::optional<FileError> damage;
};

/// The turns of one sender's sensor.
class PcapScans : public ScanReader {
public:
  PcapScans(std::filesystem::path file, std::string sender, const Sender& sent,
            std::shared_ptr<const VelodyneCalibration> calibration, std::optional<FileError> damage)
      : file_(std::move(file)),
        packets_(file_),
        sender_(std::move(sender)),
        model_(sent.finder.model().value()),
        calibration_(std::move(calibration)),
        turns_(sent.turns()),
        damage_(std::move(damage))
  {
  }

  [[nodiscard]] ScanFormat format() const override { return ScanFormat::pcap; }
  [[nodiscard]] std::size_t size() const override { return turns_.size() - 1 + (damage_ ? 1 : 0); }
  [[nodiscard]] const std::filesystem::path& path(std::size_t) const override { return file_; }
  [[nodiscard]] std::string name(std::size_t i) const override
  {
    return file_.filename().string() + " scan " + std::to_string(i);
  }
  [[nodiscard]] std::optional<double> stamp(std::size_t i) override { return turnAt(i).stamp; }

  void read(std::size_t i, pcl::PCLPointCloud2& cloud) override
  {
    const Turn& begin = turnAt(i);
    const Turn& end = turns_[i + 1];
    packets_.seek(begin.place, begin.number);
    VelodyneCloudBuilder builder(model_, 0.0, calibration_.get(), cloud);
    try {
      Datagram datagram;
      while (packets_.next(datagram) && addPacket(datagram, begin, end, builder)) {
      }
    } catch (const FileError&) {
      if (end.place >= 0) {
        throw;  // the file was changed meanwhile; a damage at its end is told by itself
      }
    }
    builder.finish();
    constexpr double kMicrosecondsPerSecond = 1e6;
    cloud.header.stamp = static_cast<std::uint64_t>(std::max(0.0, begin.stamp) * kMicrosecondsPerSecond);
    cloud.header.frame_id = "velodyne";
  }

private:
  [[nodiscard]] const Turn& turnAt(std::size_t i) const
  {
    if (i + 1 == turns_.size() && damage_) {
      throw FileError(*damage_);
    }
    if (i + 1 >= turns_.size()) {
      throw std::out_of_range("the capture has no scan " + std::to_string(i));
    }
    return turns_[i];
  }

  /// \return whether the turn goes on after this packet
  bool addPacket(const Datagram& datagram, const Turn& begin, const Turn& end, VelodyneCloudBuilder& builder) const
  {
    if (datagram.sender != sender_ || !isVelodynePacket(datagram.data)) {
      return true;
    }
    const bool last = datagram.place == end.place;
    builder.add({datagram.data, datagram.place == begin.place ? begin.block : 0, last ? end.block : kVelodyneBlocks});
    return !last;
  }

  std::filesystem::path file_;
  UdpPackets packets_;
  std::string sender_;
  VelodyneModel model_;
  std::shared_ptr<const VelodyneCalibration> calibration_;  ///< of an HDL-64
  std::vector<Turn> turns_;                                 ///< and where the last ends
  std::optional<FileError> damage_;
};

std::string nameOf(const Survey& survey, const std::filesystem::path& file, const std::string& topic)
{
  std::string names;
  for (const auto& sender : survey.senders) {
    names += (names.empty() ? "" : ", ") + sender.first;
  }
  const std::string damage = survey.damage ? std::string("; and it is damaged: ") + survey.damage->what() : "";
  if (names.empty()) {
    throw FileError(file, "has no data packets of a Velodyne among its " + std::to_string(survey.datagrams) +
                              " UDP datagrams" +
                              (survey.other.empty() ? ""
                                                    : ": they look like those of " + survey.other +
                                                          ", which are not read: convert them with its driver") +
                              damage);
  }
  if (!topic.empty() && survey.senders.count(topic) == 0) {
    throw FileError(file, "has no packets of '" + topic + "'. Lidars that sent some: " + names + damage);
  }
  if (topic.empty() && survey.senders.size() > 1) {
    throw FileError(file, "has packets of several lidars; choose one with --topic (or the argument topic): " + names);
  }
  return topic.empty() ? survey.senders.begin()->first : topic;
}

}  // namespace

bool isCapture(std::string_view begin)
{
  constexpr std::string_view kMagics[] = {{"\xA1\xB2\xC3\xD4", 4},
                                          {"\xD4\xC3\xB2\xA1", 4},
                                          {"\xA1\xB2\x3C\x4D", 4},
                                          {"\x4D\x3C\xB2\xA1", 4},
                                          {"\x0A\x0D\x0D\x0A", 4}};
  return std::find(std::begin(kMagics), std::end(kMagics), begin.substr(0, 4)) != std::end(kMagics);
}

std::unique_ptr<ScanReader> openCapture(const std::filesystem::path& file, const std::string& topic,
                                        std::shared_ptr<const VelodyneCalibration> calibration)
{
  const Survey survey(file);
  const std::string name = nameOf(survey, file, topic);
  const Sender& sender = survey.senders.at(name);
  const std::string problem = sender.finder.problem(calibration.get());
  if (!problem.empty()) {
    throw FileError(file, "what " + name + " sent " + problem);
  }
  if (!sender.finder.model()) {
    throw FileError(file, "has too few packets to tell the model of the Velodyne");
  }
  return std::make_unique<PcapScans>(file, name, sender, std::move(calibration), survey.damage);
}

std::vector<ScanTopic> sendersIn(const std::filesystem::path& file)
{
  std::vector<ScanTopic> topics;
  for (const auto& [name, sender] : Survey(file).senders) {
    topics.push_back({name, "Velodyne packets", sender.turns().size() - 1, true});
  }
  return topics;
}

}  // namespace pcl_floam
