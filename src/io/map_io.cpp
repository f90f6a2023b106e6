#include "io/pcd_body.h"
#include "io/pcd_header.h"
#include "io/whole_file.h"

#include <pcl_floam/common/cloud_view.h>
#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>

#include <cmath>
#include <fstream>
#include <iomanip>
#include <locale>
#include <system_error>

namespace pcl_floam {

namespace {

using Points = std::vector<Eigen::Vector3d>;

/// m; up to here float32 is good to a quarter of a millimetre.
constexpr double kFarthestUnshifted = 5000.0;

/// The point that a layer's coordinates are relative to: whole metres, so that it prints and reads back exactly.
Eigen::Vector3d originFor(const Points& points)
{
  if (points.empty()) {
    return Eigen::Vector3d::Zero();
  }
  Eigen::Vector3d lowest = points.front();
  Eigen::Vector3d highest = points.front();
  for (const Eigen::Vector3d& point : points) {
    lowest = lowest.cwiseMin(point);
    highest = highest.cwiseMax(point);
  }
  if (lowest.cwiseAbs().cwiseMax(highest.cwiseAbs()).maxCoeff() <= kFarthestUnshifted) {
    return Eigen::Vector3d::Zero();
  }
  return (0.5 * (lowest + highest)).array().round();
}

// Under another name until it is whole: a run that is killed meanwhile, or a full disk, leaves the former map.
// PCL's PCDWriter refuses clouds without points, and prints the VIEWPOINT with six digits only.
void writeLayer(const Points& points, const std::filesystem::path& file)
{
  const Eigen::Vector3d origin = originFor(points);
  const std::filesystem::path unfinished = file.string() + ".part";
  errno = 0;
  std::ofstream stream(unfinished, std::ios::binary);
  if (!stream) {
    throw FileError::ofSystem(file, "cannot be created");
  }
  stream.imbue(std::locale::classic());
  stream << std::fixed << std::setprecision(0);
  stream << "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
         << "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
         << "WIDTH " << points.size() << "\nHEIGHT 1\n"
         << "VIEWPOINT " << origin.x() << ' ' << origin.y() << ' ' << origin.z() << " 1 0 0 0\n"
         << "POINTS " << points.size() << "\nDATA binary\n";
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3f relative = (point - origin).cast<float>();
    stream.write(reinterpret_cast<const char*>(relative.data()), 3 * sizeof(float));
  }
  stream.close();
  std::error_code error;
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

Points readLayer(const std::filesystem::path& file)
{
  const std::string content = readWholeFile(file);
  const PcdHeader header = parsePcdHeader(file, content);
  pcl::PCLPointCloud2 cloud;
  readPcdBody(file, header, content, cloud);
  if (!header.viewpoint.allFinite()) {
    throw FileError(file, "VIEWPOINT, which the map's points are relative to, is not finite");
  }
  const CloudView view = viewOf(cloud);
  Points points(view.size);
  for (std::size_t i = 0; i < view.size; ++i) {
    points[i] = header.viewpoint + Eigen::Vector3f(view.x(i), view.y(i), view.z(i)).cast<double>();
  }
  return points;
}

}  // namespace

void saveMap(const KeyframeVoxelMap& map, const std::filesystem::path& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw FileError(folder, "cannot be created: " + error.message());
  }
  writeLayer(map.points(FeatureKind::edge), folder / kMapEdgesFile);
  writeLayer(map.points(FeatureKind::plane), folder / kMapPlanesFile);
}

KeyframeVoxelMap loadMap(const std::filesystem::path& folder, const MapParameters& parameters)
{
  KeyframeVoxelMap map(parameters);
  map.insertPoints(FeatureKind::edge, readLayer(folder / kMapEdgesFile));
  map.insertPoints(FeatureKind::plane, readLayer(folder / kMapPlanesFile));
  return map;
}

}  // namespace pcl_floam
