#include "io/pcd_body.h"
#include "io/pcd_header.h"
#include "io/whole_file.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <locale>
#include <system_error>
#include <utility>

namespace pcl_floam {

namespace {

using Points = std::vector<Eigen::Vector3d>;

struct Layer {
  Points points;
  std::vector<float> intensities;
};

constexpr std::array<std::pair<FeatureKind, const char*>, 2> kLayers{
    {{FeatureKind::edge, kMapEdgesFile}, {FeatureKind::plane, kMapPlanesFile}}};

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
void writeLayer(const Layer& layer, const std::filesystem::path& file)
{
  const Points& points = layer.points;
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
         << "FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
         << "WIDTH " << points.size() << "\nHEIGHT 1\n"
         << "VIEWPOINT " << origin.x() << ' ' << origin.y() << ' ' << origin.z() << " 1 0 0 0\n"
         << "POINTS " << points.size() << "\nDATA binary\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector4f fields;
    fields << (points[i] - origin).cast<float>(), layer.intensities[i];
    stream.write(reinterpret_cast<const char*>(fields.data()), 4 * sizeof(float));
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

Layer readLayer(const std::filesystem::path& file)
{
  const std::string content = readWholeFile(file);
  const PcdHeader header = parsePcdHeader(file, content);
  pcl::PCLPointCloud2 cloud;
  readPcdBody(file, header, content, cloud);
  if (!header.viewpoint.allFinite()) {
    throw FileError(file, "VIEWPOINT, which the map's points are relative to, is not finite");
  }
  const CloudView view = viewOf(cloud);
  Layer layer{Points(view.size), std::vector<float>(view.size, 0.0F)};
  for (std::size_t i = 0; i < view.size; ++i) {
    layer.points[i] = header.viewpoint + Eigen::Vector3f(view.x(i), view.y(i), view.z(i)).cast<double>();
    layer.intensities[i] = view.intensityOf(i);
  }
  return layer;
}

}  // namespace

void saveMap(const KeyframeVoxelMap& map, const std::filesystem::path& folder)
{
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw FileError(folder, "cannot be created: " + error.message());
  }
  for (const auto& [kind, file] : kLayers) {
    writeLayer({map.points(kind), map.intensities(kind)}, folder / file);
  }
}

KeyframeVoxelMap loadMap(const std::filesystem::path& folder, const MapParameters& parameters)
{
  KeyframeVoxelMap map(parameters);
  for (const auto& [kind, file] : kLayers) {
    const Layer layer = readLayer(folder / file);
    map.insertPoints(kind, layer.points, layer.intensities);
  }
  return map;
}

}  // namespace pcl_floam
