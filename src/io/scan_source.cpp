#include "io/pcd_body.h"
#include "io/pcd_header.h"
#include "io/scan_reader.h"
#include "io/whole_file.h"

#include <pcl_floam/io/scan_source.h>

#include <cstdint>
#include <limits>

namespace pcl_floam {

namespace fs = std::filesystem;

ScanSource::ScanSource(const fs::path& input, const std::string& topic)
    : ScanSource(input, ScanSourceOptions{topic, {}})
{
}

ScanSource::ScanSource(const fs::path& input, const ScanSourceOptions& options) : reader_(openScans(input, options))
{
  folder_ = reader_->size() > 0 ? reader_->path(0).parent_path() : input;
  if (folder_.empty()) {
    folder_ = ".";
  }
}

ScanFormat ScanSource::format() const
{
  return reader_->format();
}

std::size_t ScanSource::size() const
{
  return reader_->size();
}

const fs::path& ScanSource::path(std::size_t i) const
{
  return reader_->path(i);
}

std::string ScanSource::name(std::size_t i) const
{
  return reader_->name(i);
}

std::optional<double> ScanSource::stamp(std::size_t i) const
{
  return reader_->stamp(i);
}

void ScanSource::read(std::size_t i, pcl::PCLPointCloud2& cloud) const
{
  reader_->read(i, cloud);
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
