// Extracts edge and plane features from a PCD scan and saves the scan coloured: edges red, planes green.
//
//   ./01_extract_features scan.pcd features.pcd
// prints
//   16 scan lines from elevation clusters, 299 edges, 1723 planes
#include <pcl_floam/filters/feature_extraction.h>

#include <pcl/io/pcd_io.h>

#include <iostream>

int main(int argc, char** argv)
{
  if (argc != 3) {
    std::cerr << "usage: " << argv[0] << " scan.pcd features.pcd\n";
    return 2;
  }
  auto scan = pcl::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
  if (pcl::io::loadPCDFile(argv[1], *scan) < 0) {
    return 2;
  }

  pcl_floam::FeatureExtraction<pcl::PointXYZI> extraction;
  extraction.setInputCloud(scan);
  pcl_floam::FeatureSet features;
  if (!extraction.extract(features)) {
    std::cerr << "no features: " << toString(extraction.getScanLines().failure) << '\n';
    return 1;
  }
  std::cout << extraction.getScanLines().lines() << " scan lines from " << toString(extraction.getScanLines().source)
            << ", " << features.edges.size() << " edges, " << features.planes.size() << " planes\n";

  pcl::PointCloud<pcl::PointXYZRGB> coloured;
  for (const auto& point : *scan) {
    coloured.push_back(pcl::PointXYZRGB(point.x, point.y, point.z, 90, 90, 90));
  }
  for (const auto& edge : features.edges) {
    coloured[edge.index].rgba = 0xFFFF3030;
  }
  for (const auto& plane : features.planes) {
    coloured[plane.index].rgba = 0xFF30C030;
  }
  return pcl::io::savePCDFileBinary(argv[2], coloured) < 0 ? 1 : 0;
}
