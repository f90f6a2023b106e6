/// \file message_scans.h
/// Scans in the messages of recordings.
#pragma once

#include "io/recordings/recording.h"
#include "io/scan_reader.h"

#include <memory>
#include <vector>

namespace pcl_floam {

using Recordings = std::vector<std::unique_ptr<Recording>>;

/// The topics of all recordings.
[[nodiscard]] std::vector<ScanTopic> topicsOf(const Recordings& recordings);

/// The scans of one topic, recording after recording.
/// \param input for messages: what the user named
/// \param topic empty if there is but one
/// \throws FileError if there is no such topic, or none or several are to choose from.
[[nodiscard]] std::unique_ptr<ScanReader> openMessages(const std::filesystem::path& input, Recordings recordings,
                                                       ScanFormat format, const std::string& topic);

}  // namespace pcl_floam
