#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/scan_writer.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace pcl_floam {

namespace {

/// Under another name until it is whole: a full disk, or a run that is killed, leaves nothing half-written.
void writeFile(const std::filesystem::path& file, const std::string& content)
{
  const std::filesystem::path unfinished = file.string() + ".part";
  std::error_code error;
  errno = 0;
  std::ofstream stream(unfinished, std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) {
    const FileError problem = FileError::ofSystem(file, "cannot be written");
    std::filesystem::remove(unfinished, error);
    throw problem;
  }
  std::filesystem::rename(unfinished, file, error);
  if (error) {
    throw FileError(file, "cannot be replaced: " + error.message());
  }
}

/// What PCD calls a field's type.
struct PcdType {
  std::uint32_t size;
  char letter;
};

PcdType pcdType(const pcl::PCLPointField& field)
{
  // By PCL's number of the type: none, int8, uint8, int16, uint16, int32, uint32, float32, float64.
  constexpr std::array<PcdType, 9> kTypes{
      {{0, ' '}, {1, 'I'}, {1, 'U'}, {2, 'I'}, {2, 'U'}, {4, 'I'}, {4, 'U'}, {4, 'F'}, {8, 'F'}}};
  if (field.datatype == 0 || field.datatype >= kTypes.size()) {
    throw std::invalid_argument("field '" + field.name + "' of the cloud is of an unknown type");
  }
  return kTypes[field.datatype];
}

std::uint32_t countOf(const pcl::PCLPointField& field)
{
  return std::max<std::uint32_t>(field.count, 1);
}

void checkCloud(const pcl::PCLPointCloud2& cloud)
{
  for (const pcl::PCLPointField& field : cloud.fields) {
    const std::uint64_t bytes = static_cast<std::uint64_t>(pcdType(field).size) * countOf(field);
    if (field.offset + bytes > cloud.point_step || field.name.find_first_of(" \t\r\n") != std::string::npos ||
        field.name.empty()) {
      throw std::invalid_argument("field '" + field.name +
                                  "' of the cloud has no proper name or ends beyond its point");
    }
  }
  if (cloud.data.size() < static_cast<std::uint64_t>(cloud.width) * cloud.height * cloud.point_step) {
    throw std::invalid_argument("the cloud's data is shorter than width x height points");
  }
}

std::string headerOf(const pcl::PCLPointCloud2& cloud)
{
  std::string names = "FIELDS";
  std::string sizes = "\nSIZE";
  std::string types = "\nTYPE";
  std::string counts = "\nCOUNT";
  for (const pcl::PCLPointField& field : cloud.fields) {
    names += " " + field.name;
    sizes += " " + std::to_string(pcdType(field).size);
    types += std::string(" ") + pcdType(field).letter;
    counts += " " + std::to_string(countOf(field));
  }
  const std::uint64_t points = static_cast<std::uint64_t>(cloud.width) * cloud.height;
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + names + sizes + types + counts + "\nWIDTH " +
         std::to_string(cloud.width) + "\nHEIGHT " + std::to_string(cloud.height) +
         "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA binary\n";
}

}  // namespace

void writePcd(const pcl::PCLPointCloud2& cloud, const std::filesystem::path& file)
{
  checkCloud(cloud);
  std::string content = headerOf(cloud);
  const std::size_t points = static_cast<std::size_t>(cloud.width) * cloud.height;
  content.reserve(content.size() + points * cloud.point_step);
  for (std::size_t i = 0; i < points; ++i) {
    const std::uint8_t* point = cloud.data.data() + i * cloud.point_step;
    for (const pcl::PCLPointField& field : cloud.fields) {
      content.append(reinterpret_cast<const char*>(point) + field.offset,
                     static_cast<std::size_t>(pcdType(field).size) * countOf(field));
    }
  }
  writeFile(file, content);
}

void writePly(const std::vector<Eigen::Vector3d>& points, const std::filesystem::path& file,
              const std::vector<float>& intensities)
{
  if (!intensities.empty() && intensities.size() != points.size()) {
    throw std::invalid_argument("writePly: not as many intensities as points");
  }
  std::string content = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) +
                        "\nproperty double x\nproperty double y\nproperty double z\n" +
                        (intensities.empty() ? "" : "property float intensity\n") + "end_header\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    content.append(reinterpret_cast<const char*>(points[i].data()), 3 * sizeof(double));
    if (!intensities.empty()) {
      content.append(reinterpret_cast<const char*>(&intensities[i]), sizeof(float));
    }
  }
  writeFile(file, content);
}

}  // namespace pcl_floam
