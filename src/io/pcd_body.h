/// \file pcd_body.h
/// The points of a PCD file.
#pragma once

#include "io/pcd_header.h"

#include <pcl/PCLPointCloud2.h>

namespace pcl_floam {

/// Decodes the points that follow the header. What comes after the declared number of points is ignored.
/// \param file    for the error message
/// \param content the whole file
/// \throws FileError with place and reason if there are fewer points than declared, a number is none, or
///         compressed data do not decompress to the declared size.
void readPcdBody(const std::filesystem::path& file, const PcdHeader& header, std::string_view content,
                 pcl::PCLPointCloud2& cloud);

}  // namespace pcl_floam
