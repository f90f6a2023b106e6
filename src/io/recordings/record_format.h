/// \file record_format.h
/// What the formats that keep records in compressed chunks have in common: mcap and rosbag 1.
#pragma once

#include "io/binary_file.h"
#include "io/byte_reader.h"
#include "io/decompression.h"
#include "io/recordings/recording.h"

#include <cstdint>
#include <string_view>

namespace pcl_floam {

/// Records packed together.
struct ChunkPlace {
  std::uint64_t position = 0;  ///< byte of the file at which the chunk's record begins
  std::uint64_t data = 0;      ///< and the packed records
  std::uint64_t packed = 0;    ///< bytes of them
  std::uint64_t size = 0;      ///< bytes that they unpack to
  std::uint32_t crc = 0;       ///< of those; 0: not given
  Compression compression = Compression::none;
  bool whole = true;  ///< false: the file ends within it
};

/// Is told what a file holds.
class RecordSink {
public:
  RecordSink() = default;
  virtual ~RecordSink() = default;
  RecordSink(const RecordSink&) = delete;
  RecordSink& operator=(const RecordSink&) = delete;

  virtual void topic(std::uint32_t id, const RecordedTopic& topic) = 0;
  virtual void chunk(const ChunkPlace& chunk) = 0;
  /// A message in the chunk that was told last.
  virtual void indexEntry(std::uint32_t id, std::uint64_t time, std::uint64_t position) = 0;
  /// A message whose record begins at that byte of the file, or of the chunk that is walked.
  virtual void message(std::uint32_t id, std::uint64_t time, std::uint64_t position) = 0;
};

/// A message's record, taken apart.
struct MessageRecord {
  std::uint32_t id = 0;    ///< of the topic
  std::uint64_t time = 0;  ///< ns
  std::string_view data;
};

/// How records are written.
class RecordFormat {
public:
  RecordFormat() = default;
  virtual ~RecordFormat() = default;
  RecordFormat(const RecordFormat&) = delete;
  RecordFormat& operator=(const RecordFormat&) = delete;

  /// Tells all records of a file, without looking into its chunks.
  /// \throws FileError where the file is damaged or ends too early; what came before has been told.
  virtual void walkFile(BinaryFile& file, RecordSink& sink) = 0;

  /// Tells all records of an unpacked chunk. \throws FileError as walkFile.
  virtual void walkChunk(std::string_view records, const Origin& origin, RecordSink& sink) = 0;

  /// \throws FileError if no record of a message begins there.
  [[nodiscard]] virtual MessageRecord messageIn(std::string_view records, std::uint64_t position,
                                                const Origin& origin) const = 0;
  [[nodiscard]] virtual MessageRecord messageIn(BinaryFile& file, std::uint64_t position) const = 0;
};

}  // namespace pcl_floam
