/// \file rosbag1_format.h
/// Records of rosbag 1 (format 2.0), as http://wiki.ros.org/Bags/Format/2.0 has them.
#pragma once

#include "io/recordings/record_format.h"

#include <string_view>

namespace pcl_floam {

/// What every bag begins with, before its version.
inline constexpr std::string_view kRosbag1Magic = "#ROSBAG V";

class Rosbag1Format : public RecordFormat {
public:
  void walkFile(BinaryFile& file, RecordSink& sink) override;
  void walkChunk(std::string_view records, const Origin& origin, RecordSink& sink) override;
  [[nodiscard]] MessageRecord messageIn(std::string_view records, std::uint64_t position,
                                        const Origin& origin) const override;
  [[nodiscard]] MessageRecord messageIn(BinaryFile& file, std::uint64_t position) const override;
};

}  // namespace pcl_floam
