/// \file message_scans.h
/// Scans in the messages of recordings.
#pragma once

#include "io/recordings/recording.h"
#include "io/scan_reader.h"
#include "io/velodyne/velodyne_calibration.h"

#include <memory>
#include <vector>

namespace pcl_floam {

using Recordings = std::vector<std::unique_ptr<Recording>>;

/// The topics of all recordings.
[[nodiscard]] std::vector<ScanTopic> topicsOf(const Recordings& recordings);

/// The scans of one topic, recording after recording.
/// \param input for messages: what the user named
/// \param topic empty if there is but one
/// \param calibration of an HDL-64; null otherwise
/// \throws FileError if there is no such topic, or none or several are to choose from, or the calibration is of no use.
[[nodiscard]] std::unique_ptr<ScanReader> openMessages(const std::filesystem::path& input, Recordings recordings,
                                                       ScanFormat format, const std::string& topic,
                                                       std::shared_ptr<const VelodyneCalibration> calibration);

}  // namespace pcl_floam
