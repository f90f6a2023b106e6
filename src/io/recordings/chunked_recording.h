/// \file chunked_recording.h
/// A recording whose records lie in chunks.
#pragma once

#include "io/recordings/record_format.h"

#include <pcl_floam/io/scan_source.h>

#include <map>
#include <memory>
#include <optional>
#include <set>

namespace pcl_floam {

/// Finds messages by the file's own index where there is one, and by walking its chunks where there is none. Each
/// chunk is compared with its index when it is read. Keeps one chunk in memory, and 24 bytes for each message of the
/// topic.
class ChunkedRecording : public Recording {
public:
  /// Finds the topics. \throws FileError if the file cannot be read or is no such recording from its beginning.
  ChunkedRecording(std::filesystem::path path, std::unique_ptr<RecordFormat> format);

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.path(); }
  [[nodiscard]] const std::vector<RecordedTopic>& topics() const override { return topics_; }
  void select(std::size_t topic) override;
  [[nodiscard]] std::size_t size() const override { return entries_.size(); }
  [[nodiscard]] RecordedMessage read(std::size_t i) override;
  void rest() override;

private:
  class Collector;

  struct Entry {
    std::uint64_t time = 0;
    std::uint64_t position = 0;  ///< of the record; of a damage: its number
    std::uint32_t chunk = 0;     ///< or one of the two below
  };
  struct Chunk {
    ChunkPlace place;
    bool indexed = false;         ///< by the file; else its messages were found by walking it
    std::size_t first_entry = 0;  ///< those of a chunk follow each other
  };
  static constexpr std::uint32_t kNoChunk = 0xFFFFFFFFU;
  static constexpr std::uint32_t kDamage = 0xFFFFFFFEU;

  void survey();
  void walk(Collector& collector);
  [[nodiscard]] Origin originOf(const ChunkPlace& chunk) const;
  [[nodiscard]] std::string_view unpack(const ChunkPlace& chunk);
  void load(std::uint32_t chunk);
  void compareWithIndex(std::uint32_t chunk);

  BinaryFile file_;
  BinaryFile chunk_file_;  ///< of its own, since a chunk that is not compressed stays in its buffer
  std::unique_ptr<RecordFormat> format_;
  bool trust_index_ = true;
  std::vector<RecordedTopic> topics_;
  std::map<std::uint32_t, std::size_t> topic_of_id_;
  std::set<std::uint32_t> selected_;
  std::vector<Chunk> chunks_;
  std::vector<Entry> entries_;
  std::vector<FileError> damages_;
  std::optional<std::uint32_t> loaded_;
  std::string unpacked_;
  std::string_view records_;
};

}  // namespace pcl_floam
