#include "io/pcd_body.h"
#include "io/pcd_header.h"
#include "io/text.h"
#include "io/whole_file.h"

#include <pcl_floam/io/scan_source.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

namespace pcl_floam {

namespace fs = std::filesystem;

namespace {

bool isDigit(char c)
{
  return c >= '0' && c <= '9';
}

/// The run of digits at \p begin, without leading zeros.
std::string_view digitsAt(std::string_view text, std::size_t begin, std::size_t& end)
{
  end = begin;
  while (end < text.size() && isDigit(text[end])) {
    ++end;
  }
  while (begin + 1 < end && text[begin] == '0') {
    ++begin;
  }
  return text.substr(begin, end - begin);
}

/// Natural order: runs of digits compare as the numbers they are, however long.
bool naturallyBefore(std::string_view a, std::string_view b)
{
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (isDigit(a[i]) && isDigit(b[j])) {
      const std::string_view number_a = digitsAt(a, i, i);
      const std::string_view number_b = digitsAt(b, j, j);
      if (number_a != number_b) {
        return number_a.size() != number_b.size() ? number_a.size() < number_b.size() : number_a < number_b;
      }
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  const std::size_t rest_a = a.size() - i;
  const std::size_t rest_b = b.size() - j;
  return rest_a != rest_b ? rest_a < rest_b : a < b;  // equal but for leading zeros: any order, always the same
}

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

}  // namespace

ScanSource::ScanSource(const fs::path& folder) : folder_(folder)
{
  Listing listing = listScans(folder_);
  for (const char* subfolder : kSubfolders) {
    std::error_code error;
    if (listing.pcd.empty() && listing.bin.empty() && fs::is_directory(folder / subfolder, error)) {
      folder_ = folder / subfolder;
      listing = listScans(folder_);
    }
  }
  if (listing.pcd.empty() && listing.bin.empty()) {
    throw FileError(folder, "has no .pcd or .bin file");
  }
  if (!listing.pcd.empty() && !listing.bin.empty()) {
    throw FileError(folder_, "has both .pcd and .bin files: which are the scans?");
  }
  format_ = listing.bin.empty() ? ScanFormat::pcd : ScanFormat::kitti_bin;
  files_ = std::move(listing.bin.empty() ? listing.pcd : listing.bin);
  std::sort(files_.begin(), files_.end(), [](const fs::path& a, const fs::path& b) {
    return naturallyBefore(a.filename().string(), b.filename().string());
  });
  stamps_ = findTimes(folder_, files_.size());
}

std::optional<double> ScanSource::stamp(std::size_t i) const
{
  return stamps_.empty() ? std::nullopt : std::optional<double>(stamps_.at(i));
}

void ScanSource::read(std::size_t i, pcl::PCLPointCloud2& cloud) const
{
  if (format_ == ScanFormat::kitti_bin) {
    readKittiBin(path(i), cloud);
  } else {
    readPcd(path(i), cloud);
  }
}

void readPcd(const fs::path& file, pcl::PCLPointCloud2& cloud)
{
  const std::string content = readWholeFile(file);
  readPcdBody(file, parsePcdHeader(file, content), content, cloud);
}

void readKittiBin(const fs::path& file, pcl::PCLPointCloud2& cloud)
{
  constexpr std::uint32_t kPointBytes = 4 * sizeof(float);
  const std::string content = readWholeFile(file);
  if (content.empty()) {
    throw FileError(file, "the file is empty");
  }
  if (content.size() % kPointBytes != 0) {
    throw FileError(file, "byte " + std::to_string(content.size()) + ": the file ends within a point of " +
                              std::to_string(kPointBytes) + " bytes (x y z intensity)");
  }
  if (content.size() > std::numeric_limits<std::int32_t>::max()) {
    throw FileError(file, "is too large for one scan");
  }
  cloud.fields.clear();
  for (const char* name : {"x", "y", "z", "intensity"}) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(cloud.fields.size() * sizeof(float));
    field.datatype = pcl::PCLPointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(content.size() / kPointBytes);
  cloud.point_step = kPointBytes;
  cloud.row_step = cloud.width * kPointBytes;
  cloud.is_bigendian = 0;
  cloud.is_dense = 0;  // points that are not finite are let through
  cloud.data.assign(content.begin(), content.end());
}

}  // namespace pcl_floam
