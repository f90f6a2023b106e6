/// \file mcap_format.h
/// Records of MCAP files, as https://mcap.dev/spec has them.
#pragma once

#include "io/recordings/record_format.h"

#include <map>
#include <string>

namespace pcl_floam {

inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

class McapFormat : public RecordFormat {
public:
  void walkFile(BinaryFile& file, RecordSink& sink) override;
  void walkChunk(std::string_view records, const Origin& origin, RecordSink& sink) override;
  [[nodiscard]] MessageRecord messageIn(std::string_view records, std::uint64_t position,
                                        const Origin& origin) const override;
  [[nodiscard]] MessageRecord messageIn(BinaryFile& file, std::uint64_t position) const override;

private:
  void takeSchema(ByteReader record);
  void takeChannel(ByteReader record, RecordSink& sink) const;
  /// What a chunk and the data section may both hold; other records are passed over.
  void takeCommon(std::uint8_t opcode, ByteReader record, std::uint64_t position, RecordSink& sink);
  void takeFromFile(std::uint8_t opcode, BinaryFile& file, std::uint64_t position, std::uint64_t length,
                    RecordSink& sink);

  std::map<std::uint16_t, std::string> schemas_;  ///< names of types
};

}  // namespace pcl_floam
