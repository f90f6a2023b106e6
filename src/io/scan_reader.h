/// \file scan_reader.h
/// Scans by number, wherever they come from: what stands behind a ScanSource.
#pragma once

#include <pcl_floam/io/scan_source.h>

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace pcl_floam {

/// The scans of one input.
class ScanReader {
public:
  ScanReader() = default;
  virtual ~ScanReader() = default;
  ScanReader(const ScanReader&) = delete;
  ScanReader& operator=(const ScanReader&) = delete;

  [[nodiscard]] virtual ScanFormat format() const = 0;
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// The file that holds the scan.
  [[nodiscard]] virtual const std::filesystem::path& path(std::size_t i) const = 0;
  /// What to call the scan in a message.
  [[nodiscard]] virtual std::string name(std::size_t i) const = 0;
  [[nodiscard]] virtual std::optional<double> stamp(std::size_t i) = 0;
  virtual void read(std::size_t i, pcl::PCLPointCloud2& cloud) = 0;
};

/// A folder of .pcd or .bin files. \throws FileError as ScanSource.
[[nodiscard]] std::unique_ptr<ScanReader> openFolder(const std::filesystem::path& folder);

/// One .pcd or .bin file. \throws FileError if it is none by its name.
[[nodiscard]] std::unique_ptr<ScanReader> openScanFile(const std::filesystem::path& file);

/// Whatever \p input is. \throws FileError as ScanSource
[[nodiscard]] std::unique_ptr<ScanReader> openScans(const std::filesystem::path& input,
                                                    const ScanSourceOptions& options);

}  // namespace pcl_floam
