// Folders of scans.

#include "io/natural_order.h"
#include "io/scan_reader.h"
#include "io/text.h"
#include "io/whole_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <system_error>
#include <utility>
#include <vector>

namespace pcl_floam {

namespace fs = std::filesystem;

namespace {

std::string lowerExtension(const fs::path& file)
{
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// The scans of a folder by extension. Dangling links count: they are scans that cannot be read.
struct Listing {
  std::vector<fs::path> pcd;
  std::vector<fs::path> bin;
};

Listing listScans(const fs::path& folder)
{
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found) {
    throw FileError(folder, "no such folder");
  }
  if (error) {
    throw FileError(folder, "cannot be reached: " + error.message());
  }
  if (!fs::is_directory(status)) {
    throw FileError(folder, "is no folder");
  }
  fs::directory_iterator entries(folder, error);
  Listing listing;
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    const fs::path& file = entries->path();
    std::error_code not_followed;
    if (file.filename().string().front() == '.' || entries->is_directory(not_followed)) {
      continue;
    }
    const std::string extension = lowerExtension(file);
    if (extension == ".pcd") {
      listing.pcd.push_back(file);
    } else if (extension == ".bin") {
      listing.bin.push_back(file);
    }
  }
  if (error) {
    throw FileError(folder, "cannot be listed: " + error.message());
  }
  return listing;
}

/// One time per line; empty lines are skipped.
std::vector<double> readTimes(const fs::path& file)
{
  const std::string content = readWholeFile(file);
  std::vector<double> times;
  std::string_view rest = content;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const auto words = splitWords(takeLine(rest));
    if (words.empty()) {
      continue;
    }
    const auto time = parseNumber<double>(words.front());
    if (words.size() != 1 || !time || !std::isfinite(*time)) {
      throw FileError(file, "line " + std::to_string(line) + ": is not one time in seconds");
    }
    times.push_back(*time);
  }
  return times;
}

/// `times.txt` in the folder, else in the one above it; empty if there is none.
std::vector<double> findTimes(const fs::path& folder, std::size_t scans)
{
  std::error_code error;
  const fs::path absolute = fs::absolute(folder, error).lexically_normal();
  const fs::path itself = absolute.has_filename() ? absolute : absolute.parent_path();
  for (const fs::path& place : {itself, itself.parent_path()}) {
    const fs::path file = place / "times.txt";
    if (!fs::exists(file, error)) {
      continue;
    }
    std::vector<double> times = readTimes(file);
    if (times.size() != scans) {
      throw FileError(file, "has " + std::to_string(times.size()) + " times for " + std::to_string(scans) + " scans");
    }
    return times;
  }
  return {};
}

/// KITTI keeps a sequence's scans in a folder of its own below the sequence's.
constexpr const char* kSubfolders[] = {"velodyne", "velodyne_points/data"};

/// Files of one scan each.
class ScanFiles : public ScanReader {
public:
  ScanFiles(std::vector<fs::path> files, std::vector<double> stamps, ScanFormat format)
      : files_(std::move(files)), stamps_(std::move(stamps)), format_(format)
  {
  }

  [[nodiscard]] ScanFormat format() const override { return format_; }
  [[nodiscard]] std::size_t size() const override { return files_.size(); }
  [[nodiscard]] const fs::path& path(std::size_t i) const override { return files_.at(i); }
  [[nodiscard]] std::string name(std::size_t i) const override { return files_.at(i).filename().string(); }

  [[nodiscard]] std::optional<double> stamp(std::size_t i) override
  {
    return stamps_.empty() ? std::nullopt : std::optional<double>(stamps_.at(i));
  }

  void read(std::size_t i, pcl::PCLPointCloud2& cloud) override
  {
    if (format_ == ScanFormat::kitti_bin) {
      readKittiBin(path(i), cloud);
    } else {
      readPcd(path(i), cloud);
    }
  }

private:
  std::vector<fs::path> files_;
  std::vector<double> stamps_;
  ScanFormat format_;
};

}  // namespace

std::unique_ptr<ScanReader> openFolder(const fs::path& folder)
{
  fs::path place = folder;
  Listing listing = listScans(place);
  for (const char* subfolder : kSubfolders) {
    std::error_code error;
    if (listing.pcd.empty() && listing.bin.empty() && fs::is_directory(folder / subfolder, error)) {
      place = folder / subfolder;
      listing = listScans(place);
    }
  }
  if (listing.pcd.empty() && listing.bin.empty()) {
    throw FileError(folder, "has no .pcd or .bin file, and no recording (.mcap, .db3, .bag)");
  }
  if (!listing.pcd.empty() && !listing.bin.empty()) {
    throw FileError(place, "has both .pcd and .bin files: which are the scans?");
  }
  const ScanFormat format = listing.bin.empty() ? ScanFormat::pcd : ScanFormat::kitti_bin;
  std::vector<fs::path> files = std::move(listing.bin.empty() ? listing.pcd : listing.bin);
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return naturallyBefore(a.filename().string(), b.filename().string());
  });
  std::vector<double> stamps = findTimes(place, files.size());
  return std::make_unique<ScanFiles>(std::move(files), std::move(stamps), format);
}

std::unique_ptr<ScanReader> openScanFile(const fs::path& file)
{
  const std::string extension = lowerExtension(file);
  if (extension != ".pcd" && extension != ".bin") {
    std::error_code error;
    if (fs::file_size(file, error) == 0 && !error) {
      throw FileError(file, "the file is empty");
    }
    throw FileError(file, "byte 0: is no scan (.pcd, .bin) and no recording that is read (mcap, rosbag 1 or 2, pcap)");
  }
  return std::make_unique<ScanFiles>(std::vector<fs::path>{file}, std::vector<double>(),
                                     extension == ".bin" ? ScanFormat::kitti_bin : ScanFormat::pcd);
}

}  // namespace pcl_floam
