/// \file scan_writer.h
/// Scans and points to PCD and PLY files.
#pragma once

#include <pcl_floam/io/file_error.h>

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace pcl_floam {

/// Writes a cloud as a binary PCD file with all its fields, one after another without gaps. A file of that name is
/// replaced once the new one is whole.
/// \throws FileError if it cannot be written.
/// \throws std::invalid_argument if the cloud contradicts itself: a field that ends beyond its point, too few bytes.
void writePcd(const pcl::PCLPointCloud2& cloud, const std::filesystem::path& file);

/// Writes points as a binary PLY file (x, y, z float64, and intensity float32 if there are any), likewise.
/// \throws FileError if it cannot be written.
/// \throws std::invalid_argument if there are as many intensities neither as points nor as none
void writePly(const std::vector<Eigen::Vector3d>& points, const std::filesystem::path& file,
              const std::vector<float>& intensities = {});

}  // namespace pcl_floam
