// Maps from files of any bytes.
#include "fuzz/fuzz_input.h"
#include "fuzz/fuzz_targets.h"

#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>

namespace pcl_floam::test {

namespace {

void checkMap(const KeyframeVoxelMap& map, FeatureKind kind)
{
  const std::vector<Eigen::Vector3d> points = map.points(kind);
  mustHold(points.size() == map.size(kind), "a map counts other points than it has");
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 8) {
    mustHold(points[i].allFinite(), "a map's point is not finite");
    Neighbors neighbors;
    map.search(kind).nearest(points[i], 5, 1.0, neighbors);
    mustHold(neighbors.count > 0, "a map's point is not found where it is");
  }
}

}  // namespace

void fuzzMap(const std::uint8_t* bytes, std::size_t size)
{
  static const TemporaryFolder folder;
  static const TemporaryFolder copy;
  writeInput(folder, kMapEdgesFile, bytes, size);
  writeInput(folder, kMapPlanesFile, bytes, size);
  KeyframeVoxelMap map;
  try {
    map = loadMap(folder.path());
  } catch (const FileError&) {
    return;
  }
  checkMap(map, FeatureKind::edge);
  checkMap(map, FeatureKind::plane);
  saveMap(map, copy.path());
  (void)loadMap(copy.path());
}

}  // namespace pcl_floam::test
