/// \file pcap_scans.h
/// Scans in captured network packets.
#pragma once

#include "io/scan_reader.h"
#include "io/velodyne/velodyne_calibration.h"

#include <string_view>

namespace pcl_floam {

/// Whether a file begins as a capture: pcap with micro- or nanoseconds, of either byte order, or pcapng.
[[nodiscard]] bool isCapture(std::string_view begin);

/// The turns of a Velodyne in a capture. \param topic the sender as address:port; empty if there is but one
/// \param calibration of an HDL-64; null otherwise
/// \throws FileError if there are no such packets, those of another lidar, or of several, or if the calibration is
///         missing or of no use.
[[nodiscard]] std::unique_ptr<ScanReader> openCapture(const std::filesystem::path& file, const std::string& topic,
                                                      std::shared_ptr<const VelodyneCalibration> calibration);

/// Who sends packets of a Velodyne, as topics. \throws FileError if the capture cannot be read from its beginning.
[[nodiscard]] std::vector<ScanTopic> sendersIn(const std::filesystem::path& file);

}  // namespace pcl_floam
