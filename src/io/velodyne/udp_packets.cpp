#include "io/velodyne/udp_packets.h"

#include <pcl_floam/io/scan_source.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#ifdef PCL_FLOAM_WITH_PCAP
#include <pcap/pcap.h>
#endif

namespace pcl_floam {

#ifndef PCL_FLOAM_WITH_PCAP

class UdpPackets::Capture {};

UdpPackets::UdpPackets(const std::filesystem::path& file)
{
  throw FileError(file,
                  "is a capture of network packets (pcap), which this build left out: install libpcap-dev and "
                  "configure pcl_floam again");
}

bool UdpPackets::next(Datagram&)
{
  return false;
}

void UdpPackets::seek(std::int64_t, std::uint64_t) {}

#else

namespace {

/// Bytes of a packet from outside to inside; numbers as networks have them, big-endian.
class Layers {
public:
  explicit Layers(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] bool has(std::size_t count) const { return bytes_.size() >= count; }
  [[nodiscard]] std::size_t byte(std::size_t i) const { return static_cast<std::uint8_t>(bytes_[i]); }
  [[nodiscard]] std::size_t word(std::size_t i) const { return 256U * byte(i) + byte(i + 1); }
  void strip(std::size_t count) { bytes_.remove_prefix(std::min(count, bytes_.size())); }
  void shorten(std::size_t count) { bytes_ = bytes_.substr(0, count); }
  [[nodiscard]] std::string_view rest() const { return bytes_; }

private:
  std::string_view bytes_;
};

constexpr std::size_t kIpv4 = 0x0800;
constexpr std::size_t kVlan = 0x8100;

/// Strips what is around the IP packet. \return false if it is of another protocol
bool stripLink(int link, Layers& layers)
{
  struct Link {
    int type;
    std::size_t bytes;
    std::size_t protocol;  ///< where its number stands
  };
  constexpr Link kLinks[] = {{DLT_EN10MB, 14, 12}, {DLT_LINUX_SLL, 16, 14}, {276 /* Linux cooked 2 */, 20, 0}};
  if (link == DLT_RAW || link == DLT_IPV4) {
    return true;
  }
  if (link == DLT_NULL) {
    layers.strip(4);
    return true;
  }
  for (const Link& known : kLinks) {
    if (known.type == link && layers.has(known.bytes)) {
      std::size_t protocol = layers.word(known.protocol);
      layers.strip(known.bytes);
      while (protocol == kVlan && layers.has(4)) {
        protocol = layers.word(2);
        layers.strip(4);
      }
      return protocol == kIpv4;
    }
  }
  return false;
}

/// What a whole UDP datagram carries. Sensors' packets are small enough to come in one piece.
std::optional<std::string_view> payloadOf(Layers layers, std::string& sender)
{
  constexpr std::size_t kUdp = 17;
  constexpr std::size_t kUdpHead = 8;
  if (!layers.has(20) || layers.byte(0) / 16U != 4 || layers.byte(9) != kUdp || layers.word(6) % 0x2000U != 0) {
    return std::nullopt;
  }
  sender.clear();
  for (std::size_t i = 12; i < 16; ++i) {
    sender += (i > 12 ? "." : "") + std::to_string(layers.byte(i));
  }
  layers.strip(4 * (layers.byte(0) % 16U));
  if (!layers.has(kUdpHead) || layers.word(4) < kUdpHead) {
    return std::nullopt;
  }
  sender += ":" + std::to_string(layers.word(2));
  layers.shorten(layers.word(4));  // small frames are filled up
  layers.strip(kUdpHead);
  return layers.rest();
}

}  // namespace

class UdpPackets::Capture {
public:
  explicit Capture(const std::filesystem::path& file) : file_(file), pcap_(nullptr, pcap_close)
  {
    errno = 0;
    std::FILE* stream = std::fopen(file.c_str(), "rb");
    if (stream == nullptr) {
      throw FileError::ofSystem(file, "cannot be opened");
    }
    char problem[PCAP_ERRBUF_SIZE] = "";
    pcap_.reset(pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, problem));
    if (!pcap_) {
      std::fclose(stream);
      throw FileError(file, std::string("byte 0: libpcap says: ") + problem);
    }
  }

  bool next(Datagram& datagram)
  {
    for (;;) {
      pcap_pkthdr* head = nullptr;
      const u_char* bytes = nullptr;
      datagram.place = std::ftell(pcap_file(pcap_.get()));
      const int status = pcap_next_ex(pcap_.get(), &head, &bytes);
      if (status == PCAP_ERROR_BREAK) {
        return false;
      }
      ++number_;
      if (status != 1) {
        throw FileError(file_, "byte " + std::to_string(datagram.place) + ", packet " + std::to_string(number_) +
                                   ": libpcap says: " + pcap_geterr(pcap_.get()) +
                                   ": the capture was cut off or is damaged");
      }
      Layers layers(std::string_view(reinterpret_cast<const char*>(bytes), head->caplen));
      const auto payload =
          stripLink(pcap_datalink(pcap_.get()), layers) ? payloadOf(layers, datagram.sender) : std::nullopt;
      if (payload) {
        datagram.data = *payload;
        datagram.time = static_cast<double>(head->ts.tv_sec) + 1e-9 * static_cast<double>(head->ts.tv_usec);
        datagram.number = number_;
        return true;
      }
    }
  }

  void seek(std::int64_t place, std::uint64_t number)
  {
    std::fseek(pcap_file(pcap_.get()), place, SEEK_SET);
    number_ = number - 1;
  }

private:
  std::filesystem::path file_;
  std::unique_ptr<pcap_t, void (*)(pcap_t*)> pcap_;
  std::uint64_t number_ = 0;
};

UdpPackets::UdpPackets(const std::filesystem::path& file) : capture_(std::make_unique<Capture>(file)) {}

bool UdpPackets::next(Datagram& datagram)
{
  return capture_->next(datagram);
}

void UdpPackets::seek(std::int64_t place, std::uint64_t number)
{
  capture_->seek(place, number);
}

#endif

UdpPackets::~UdpPackets() = default;

}  // namespace pcl_floam
