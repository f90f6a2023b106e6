#include "io/recordings/mcap_format.h"

#include <pcl_floam/io/scan_source.h>

#include <algorithm>

namespace pcl_floam {

namespace {

enum McapOpcode : std::uint8_t {
  kMcapFooter = 0x02,
  kMcapSchema = 0x03,
  kMcapChannel = 0x04,
  kMcapMessage = 0x05,
  kMcapChunk = 0x06,
  kMcapMessageIndex = 0x07
};

constexpr std::uint64_t kRecordHead = 9;    ///< bytes: opcode and length
constexpr std::uint64_t kMessageHead = 22;  ///< bytes: channel, sequence, two times
constexpr std::uint64_t kLongestChunkHead = 512;

MessageRecord takeMessage(ByteReader record)
{
  MessageRecord message;
  message.id = record.number<std::uint16_t>();
  record.skip(sizeof(std::uint32_t));
  message.time = record.number<std::uint64_t>();
  record.skip(sizeof(std::uint64_t));
  message.data = record.take(record.left());
  return message;
}

void takeIndex(ByteReader record, RecordSink& sink)
{
  constexpr std::uint32_t kEntry = 16;
  const auto id = record.number<std::uint16_t>();
  const auto bytes = record.number<std::uint32_t>();
  if (bytes != record.left() || bytes % kEntry != 0) {
    record.fail("the index of a chunk is of " + std::to_string(record.left()) + " bytes, but tells " +
                std::to_string(bytes));
  }
  while (record.left() > 0) {
    const auto time = record.number<std::uint64_t>();
    sink.indexEntry(id, time, record.number<std::uint64_t>());
  }
}

/// \param left bytes of the file from \p position on
ChunkPlace takeChunk(ByteReader record, std::uint64_t position, std::uint64_t length, std::uint64_t left)
{
  ChunkPlace chunk;
  chunk.position = position;
  record.skip(2 * sizeof(std::uint64_t));
  chunk.size = record.number<std::uint64_t>();
  chunk.crc = record.number<std::uint32_t>();
  chunk.compression = compressionOf(record.counted(), record.origin());
  chunk.packed = record.number<std::uint64_t>();
  if (chunk.packed != length - record.position()) {
    record.fail("the chunk tells " + std::to_string(chunk.packed) + " bytes of records, but has room for " +
                std::to_string(length - record.position()));
  }
  chunk.data = position + kRecordHead + record.position();
  chunk.whole = left - kRecordHead >= length;
  chunk.packed = chunk.whole ? chunk.packed : left - kRecordHead - record.position();
  return chunk;
}

[[noreturn]] void failCutOffMcap(const BinaryFile& file, std::uint64_t position)
{
  throw FileError(file.path(), "byte " + std::to_string(file.size()) + ": the file ends within the record at byte " +
                                   std::to_string(position) + ": the recording was cut off, what followed is missing");
}

}  // namespace

void McapFormat::walkFile(BinaryFile& file, RecordSink& sink)
{
  if (file.viewUpTo(0, kMcapMagic.size()) != kMcapMagic) {
    throw FileError(file.path(), "byte 0: is no MCAP file");
  }
  for (std::uint64_t position = kMcapMagic.size(); position < file.size();) {
    const std::uint64_t left = file.size() - position;
    if (left < kRecordHead) {
      failCutOffMcap(file, position);
    }
    const Origin origin{file.path(), "", position};
    ByteReader head(file.view(position, kRecordHead), origin);
    const auto opcode = head.number<std::uint8_t>();
    const auto length = head.number<std::uint64_t>();
    if (opcode == 0) {
      origin.fail(0, "no record begins here: the file is damaged, what follows is not read");
    }
    if (length > left - kRecordHead) {
      if (opcode == kMcapChunk && left > kRecordHead) {
        const Origin within{file.path(), "", position + kRecordHead};
        sink.chunk(takeChunk({file.viewUpTo(within.begin, kLongestChunkHead), within}, position, length, left));
      }
      failCutOffMcap(file, position);
    }
    if (opcode == kMcapFooter) {
      return;
    }
    takeFromFile(opcode, file, position, length, sink);
    position += kRecordHead + length;
  }
  throw FileError(file.path(), "byte " + std::to_string(file.size()) +
                                   ": the file ends without its footer: the recording was cut off, and what followed, "
                                   "if anything, is missing");
}

void McapFormat::takeFromFile(std::uint8_t opcode, BinaryFile& file, std::uint64_t position, std::uint64_t length,
                              RecordSink& sink)
{
  const Origin origin{file.path(), "", position + kRecordHead};
  const auto content = [&](std::uint64_t most) {
    return ByteReader(file.view(origin.begin, std::min(length, most)), origin);
  };
  switch (opcode) {
    case kMcapChunk: sink.chunk(takeChunk(content(kLongestChunkHead), position, length, file.size() - position)); break;
    case kMcapMessageIndex: takeIndex(content(length), sink); break;
    case kMcapMessage: takeCommon(opcode, content(kMessageHead), position, sink); break;
    case kMcapSchema:
    case kMcapChannel: takeCommon(opcode, content(length), position, sink); break;
    default: break;
  }
}

void McapFormat::walkChunk(std::string_view records, const Origin& origin, RecordSink& sink)
{
  ByteReader reader(records, origin);
  while (reader.left() > 0) {
    const std::uint64_t position = reader.position();
    const auto opcode = reader.number<std::uint8_t>();
    const auto length = reader.number<std::uint64_t>();
    const Origin within{origin.file, origin.part, origin.begin + reader.position()};
    takeCommon(opcode, ByteReader(reader.take(length), within), position, sink);
  }
}

void McapFormat::takeCommon(std::uint8_t opcode, ByteReader record, std::uint64_t position, RecordSink& sink)
{
  if (opcode == kMcapSchema) {
    takeSchema(record);
  } else if (opcode == kMcapChannel) {
    takeChannel(record, sink);
  } else if (opcode == kMcapMessage) {
    const MessageRecord message = takeMessage(record);
    sink.message(message.id, message.time, position);
  }
}

void McapFormat::takeSchema(ByteReader record)
{
  const auto id = record.number<std::uint16_t>();
  schemas_[id] = record.counted();
}

void McapFormat::takeChannel(ByteReader record, RecordSink& sink) const
{
  const auto id = record.number<std::uint16_t>();
  const auto schema = schemas_.find(record.number<std::uint16_t>());
  RecordedTopic topic;
  topic.type = schema == schemas_.end() ? "" : schema->second;
  topic.name = record.counted();
  topic.encoding = record.counted();
  sink.topic(id, topic);
}

MessageRecord McapFormat::messageIn(std::string_view records, std::uint64_t position, const Origin& origin) const
{
  ByteReader reader(records, origin);
  reader.skip(position);
  if (reader.number<std::uint8_t>() != kMcapMessage) {
    reader.fail("no message begins here, as the index tells: the file is damaged");
  }
  const auto length = reader.number<std::uint64_t>();
  return takeMessage({reader.take(length), origin});
}

MessageRecord McapFormat::messageIn(BinaryFile& file, std::uint64_t position) const
{
  const Origin origin{file.path(), "", position};
  ByteReader head(file.view(position, kRecordHead), origin);
  head.skip(1);
  const auto length = head.number<std::uint64_t>();
  if (length > file.size()) {
    origin.fail(0, "the file was changed meanwhile");
  }
  return messageIn(file.view(position, kRecordHead + length), 0, origin);
}

}  // namespace pcl_floam
