/// \file scan_source.h
/// Scans on disk: folders of PCD files or KITTI's .bin files, and recordings (mcap, rosbag, pcap).
#pragma once

#include <pcl_floam/io/file_error.h>

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_floam {

class ScanReader;

/// What a source's scans are kept in.
enum class ScanFormat { pcd, kitti_bin, mcap, rosbag1, rosbag2, pcap };

/// A topic of a recording.
struct ScanTopic {
  std::string name;
  std::string type;            ///< of its messages, for example sensor_msgs/msg/PointCloud2
  std::uint64_t messages = 0;  ///< how many
  bool has_scans = false;      ///< it can be given to a ScanSource
};

/// What else a ScanSource may have to know.
struct ScanSourceOptions {
  /// Of a recording with several: which; of a pcap the sender, as address:port. Empty: there is but one.
  std::string topic;
  /// The calibration of a Velodyne HDL-64, whose packets cannot be decoded without: its maker's db.xml, or the YAML
  /// that the ROS driver makes of it. Empty: none. Other inputs refuse one.
  std::filesystem::path calibration;
};

/// The scans of a folder or of a recording, by number.
///
/// The input may be
/// - a folder of `.pcd` files or of KITTI's `.bin` files, in natural order of their names (scan2 before scan10). Beside
///   the scans, or in the folder above them, a `times.txt` may give one time in seconds per scan. For a folder without
///   scans its subfolder `velodyne` or `velodyne_points/data` is taken: a sequence of KITTI's;
/// - one such file;
/// - an MCAP file, a rosbag of ROS 1 or a folder of the parts that it was split into, a rosbag2's folder or a `.db3`
///   file of it, with messages of the types PointCloud2, Livox' CustomMsg, or VelodyneScan;
/// - a pcap or pcapng file with packets of a Velodyne VLP-16, HDL-32E or HDL-64E (S2, S3).
///
/// What it is, its first bytes tell, not its name. Formats whose library was missing when pcl_floam was built are
/// refused with the library's name.
///
/// Scans are read when they are asked for; of a recording, one of its chunks and a few bytes for each scan are in
/// memory. A place where a recording is damaged or cut off counts as a scan, which cannot be read: whoever reads all
/// scans gets those before the damage, then the reason. A source is not for several threads at once, nor are its
/// copies.
class ScanSource {
public:
  /// Lists the scans. Reads none yet, but the first of a recording's messages, which tells whether its topic holds
  /// scans.
  ///
  /// \param topic of a recording with several: which; of a pcap the sender, as address:port
  /// \throws FileError if the input cannot be read, holds no scans or several kinds of them, has several topics and
  /// none is named, or if `times.txt` has a line that is no number or does not fit the number of scans.
  explicit ScanSource(const std::filesystem::path& input, const std::string& topic = "");

  /// The same with more to know.
  /// \throws FileError as the other, and if the calibration cannot be read, is missing or of no use.
  ScanSource(const std::filesystem::path& input, const ScanSourceOptions& options);

  /// The folder that holds the scans, or the recording.
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] ScanFormat format() const;

  /// The file that holds scan \p i.
  [[nodiscard]] const std::filesystem::path& path(std::size_t i) const;

  /// What to call scan \p i in a message: its file's name, and its number in that file if there are several.
  [[nodiscard]] std::string name(std::size_t i) const;

  /// Seconds: from `times.txt`, nothing without that file; or the stamp of the recorded message, which is read for it.
  /// \throws FileError as \ref read.
  [[nodiscard]] std::optional<double> stamp(std::size_t i) const;

  /// Reads scan \p i with all its fields; KITTI's have x, y, z and intensity. x, y, z are float32: float64 is turned
  /// into that, which costs precision far from the origin (half a metre in UTM coordinates).
  /// \throws FileError if the file is missing, truncated, damaged or no such file.
  void read(std::size_t i, pcl::PCLPointCloud2& cloud) const;

private:
  std::shared_ptr<ScanReader> reader_;
  std::filesystem::path folder_;
};

/// The topics of a recording, with those that hold no scans; none for a folder of scans.
/// \throws FileError as ScanSource.
[[nodiscard]] std::vector<ScanTopic> listTopics(const std::filesystem::path& input);

/// Whether a file is a calibration for ScanSourceOptions by its kind: XML, or YAML with a list of lasers.
/// \throws FileError if it cannot be read.
[[nodiscard]] bool isLaserCalibration(const std::filesystem::path& file);

/// Reads one PCD file (ascii, binary, binary_compressed) with all its fields but 64-bit integers, for which PCL has no
/// name before 1.14; their bytes stay in the points. What follows the declared number of points is ignored.
/// x, y, z of float64 become float32, as in ScanSource::read.
/// \throws FileError as ScanSource::read, or if x, y, z are neither float32 nor float64.
void readPcd(const std::filesystem::path& file, pcl::PCLPointCloud2& cloud);

/// Reads one KITTI file: float32 x, y, z, intensity per point.
/// \throws FileError as ScanSource::read.
void readKittiBin(const std::filesystem::path& file, pcl::PCLPointCloud2& cloud);

}  // namespace pcl_floam
