/// \file scan_source.h
/// A folder of scans on disk: PCD files or KITTI's .bin files.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace pcl_floam {

/// A file could not be read or written. `what()` names the file, the place in it, and the reason.
class FileError : public std::runtime_error {
public:
  FileError(std::filesystem::path path, const std::string& reason)
      : std::runtime_error(path.string() + ": " + reason), path_(std::move(path))
  {
  }

  /// An error whose reason the system knows: to be called right after what failed (it reads `errno`).
  [[nodiscard]] static FileError ofSystem(std::filesystem::path path, const std::string& what)
  {
    const int code = errno;
    return {std::move(path), code == 0 ? what : what + ": " + std::generic_category().message(code)};
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

/// Format of a folder's scans.
enum class ScanFormat { pcd, kitti_bin };

/// The scans of a folder, in natural order of their names (scan2 before scan10).
///
/// Beside the scans, or in the folder above them, a `times.txt` may give one time in seconds per scan. For a folder
/// without scans its subfolder `velodyne` or `velodyne_points/data` is taken: a sequence of KITTI's.
class ScanSource {
public:
  /// Lists the folder. Reads no scan yet.
  /// \throws FileError if the folder cannot be read, holds no `.pcd` or `.bin` file or both kinds, or if
  ///         `times.txt` has a line that is no number or does not fit the number of scans.
  explicit ScanSource(const std::filesystem::path& folder);

  /// The folder that holds the scans.
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::size_t size() const { return files_.size(); }
  [[nodiscard]] ScanFormat format() const { return format_; }
  [[nodiscard]] const std::filesystem::path& path(std::size_t i) const { return files_.at(i); }

  /// Seconds, from `times.txt`; nothing without that file.
  [[nodiscard]] std::optional<double> stamp(std::size_t i) const;

  /// Reads scan \p i with all its fields; KITTI's have x, y, z and intensity.
  /// \throws FileError if the file is missing, truncated or no such file.
  void read(std::size_t i, pcl::PCLPointCloud2& cloud) const;

private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> files_;
  std::vector<double> stamps_;
  ScanFormat format_ = ScanFormat::pcd;
};

/// Reads one PCD file (ascii, binary, binary_compressed) with all its fields but 64-bit integers, for which PCL has no
/// name before 1.14; their bytes stay in the points. What follows the declared number of points is ignored.
/// \throws FileError as ScanSource::read, or if x, y, z are not float32.
void readPcd(const std::filesystem::path& file, pcl::PCLPointCloud2& cloud);

/// Reads one KITTI file: float32 x, y, z, intensity per point.
/// \throws FileError as ScanSource::read.
void readKittiBin(const std::filesystem::path& file, pcl::PCLPointCloud2& cloud);

}  // namespace pcl_floam
