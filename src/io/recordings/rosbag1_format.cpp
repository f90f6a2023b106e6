#include "io/recordings/rosbag1_format.h"

#include <pcl_floam/io/scan_source.h>

#include <algorithm>
#include <optional>

namespace pcl_floam {

namespace {

enum BagOpcode : std::uint8_t {
  kBagMessageData = 0x02,
  kBagHeader = 0x03,
  kBagIndexData = 0x04,
  kBagChunk = 0x05,
  kBagChunkInfo = 0x06,
  kBagConnection = 0x07
};

constexpr std::uint64_t kNanosecondsPerSecond = 1000000000;
constexpr std::uint32_t kLongestHeader = 1U << 16U;  ///< bytes; headers have a few fields

/// The fields of a record's header, name=value each.
class Fields {
public:
  Fields(std::string_view bytes, const Origin& origin) : bytes_(bytes), origin_(&origin) {}

  /// The value of a field; nothing if there is none of that name.
  [[nodiscard]] std::optional<std::string_view> text(std::string_view name) const
  {
    ByteReader reader(bytes_, *origin_);
    while (reader.left() > 0) {
      const std::string_view field = reader.counted();
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) {
        reader.fail("a field of a record's header is no name=value: the file is damaged");
      }
      if (field.substr(0, equals) == name) {
        return field.substr(equals + 1);
      }
    }
    return std::nullopt;
  }

  template <typename Number>
  [[nodiscard]] Number number(std::string_view name) const
  {
    const auto value = text(name);
    if (!value || value->size() != sizeof(Number)) {
      origin_->fail(0, "the record's header has no field '" + std::string(name) + "' of " +
                           std::to_string(sizeof(Number)) + " bytes: the file is damaged");
    }
    return ByteReader(*value, *origin_).number<Number>();
  }

private:
  std::string_view bytes_;
  const Origin* origin_;
};

/// Seconds and nanoseconds, 32 bits each, as nanoseconds.
std::uint64_t nanoseconds(std::uint64_t time)
{
  return (time & 0xFFFFFFFFU) * kNanosecondsPerSecond + (time >> 32U);
}

/// Where a record of the file has its parts.
struct FileRecord {
  std::uint64_t header = 0;
  std::uint32_t header_bytes = 0;
  std::uint64_t data = 0;
  std::uint64_t data_bytes = 0;
  std::uint64_t end = 0;  ///< may be beyond the file's
};

[[noreturn]] void failCutOffBag(const BinaryFile& file, std::uint64_t position)
{
  throw FileError(file.path(), "byte " + std::to_string(file.size()) + ": the bag ends within the record at byte " +
                                   std::to_string(position) + ": it was cut off, what followed is missing");
}

FileRecord recordAt(BinaryFile& file, std::uint64_t position)
{
  constexpr std::uint64_t kLength = sizeof(std::uint32_t);
  const Origin origin{file.path(), "", position};
  const auto lengthAt = [&](std::uint64_t place) {
    if (place > file.size() || file.size() - place < kLength) {
      failCutOffBag(file, position);
    }
    return ByteReader(file.view(place, kLength), origin).number<std::uint32_t>();
  };
  FileRecord record;
  record.header_bytes = lengthAt(position);
  if (record.header_bytes > kLongestHeader) {
    origin.fail(0, "no record begins here: the file is damaged, what follows is not read");
  }
  record.header = position + kLength;
  record.data_bytes = lengthAt(record.header + record.header_bytes);
  record.data = record.header + record.header_bytes + kLength;
  record.end = record.data + record.data_bytes;
  return record;
}

MessageRecord messageFrom(const Fields& header, std::string_view data)
{
  return {header.number<std::uint32_t>("conn"), nanoseconds(header.number<std::uint64_t>("time")), data};
}

void takeConnection(const Fields& header, const Fields& data, RecordSink& sink)
{
  RecordedTopic topic;
  topic.name = header.text("topic").value_or("");
  topic.type = data.text("type").value_or("");
  topic.encoding = "ros1";
  sink.topic(header.number<std::uint32_t>("conn"), topic);
}

void takeIndex(const Fields& header, ByteReader data, RecordSink& sink)
{
  constexpr std::uint64_t kEntry = 12;
  const auto id = header.number<std::uint32_t>("conn");
  const auto count = header.number<std::uint32_t>("count");
  if (header.number<std::uint32_t>("ver") != 1 || data.left() != kEntry * count) {
    data.fail("the index of a chunk is not of version 1, or not of " + std::to_string(count) +
              " entries: the file is damaged");
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t time = nanoseconds(data.number<std::uint64_t>());
    sink.indexEntry(id, time, data.number<std::uint32_t>());
  }
}

ChunkPlace takeChunk(const Fields& header, const FileRecord& record, std::uint64_t position, const Origin& origin,
                     std::uint64_t file_size)
{
  ChunkPlace chunk;
  chunk.position = position;
  chunk.data = record.data;
  chunk.whole = record.end <= file_size;
  chunk.packed = chunk.whole ? record.data_bytes : file_size - record.data;
  chunk.size = header.number<std::uint32_t>("size");
  chunk.compression = compressionOf(header.text("compression").value_or("(none given)"), origin);
  return chunk;
}

/// What the bag's first record says of it.
struct BagHeader {
  std::uint64_t index = 0;  ///< position; 0: the bag was not closed
  std::uint32_t chunks = 0;
};

BagHeader takeBagHeader(const Fields& header, const Origin& origin)
{
  const auto encryptor = header.text("encryptor");
  if (encryptor && !encryptor->empty()) {
    origin.fail(0, "the bag is encrypted (" + std::string(encryptor->substr(0, 80)) +
                       "): decrypt it with rosbag decrypt first");
  }
  return {header.number<std::uint64_t>("index_pos"), header.number<std::uint32_t>("chunk_count")};
}

/// Walks a bag's records.
class BagWalk {
public:
  BagWalk(BinaryFile& file, RecordSink& sink) : file_(file), sink_(sink) {}

  void walk(std::uint64_t position)
  {
    while (position < file_.size()) {
      const FileRecord record = recordAt(file_, position);
      const std::string header_bytes(file_.view(record.header, record.header_bytes));
      const Origin origin{file_.path(), "", record.header};
      const Fields header(header_bytes, origin);
      const auto opcode = header.number<std::uint8_t>("op");
      if (opcode == kBagChunk && record.data <= file_.size()) {
        sink_.chunk(takeChunk(header, record, position, origin, file_.size()));
        ++chunks_;
      }
      if (record.end > file_.size()) {
        failCutOffBag(file_, position);
      }
      take(opcode, header, record, position);
      position = record.end;
    }
    checkEnd();
  }

private:
  void take(std::uint8_t opcode, const Fields& header, const FileRecord& record, std::uint64_t position)
  {
    const Origin origin{file_.path(), "", record.data};
    const auto data = [&] { return file_.view(record.data, record.data_bytes); };
    switch (opcode) {
      case kBagHeader: bag_ = takeBagHeader(header, origin); break;
      case kBagIndexData: takeIndex(header, {data(), origin}, sink_); break;
      case kBagConnection: takeConnection(header, {data(), origin}, sink_); break;
      case kBagMessageData: {
        const MessageRecord message = messageFrom(header, {});
        sink_.message(message.id, message.time, position);
        break;
      }
      case kBagChunkInfo: ++infos_; break;
      case kBagChunk: break;
      default: origin.fail(0, "a record of kind " + std::to_string(opcode) + " is unknown: the file is damaged");
    }
  }

  /// A lost chunk must not go unnoticed.
  void checkEnd() const
  {
    const std::string end = "byte " + std::to_string(file_.size()) + ": ";
    if (bag_.index == 0) {
      throw FileError(file_.path(), end +
                                        "the bag has no index: its recording was not finished, and what followed, if "
                                        "anything, is missing; rosbag reindex writes an index");
    }
    if (bag_.chunks != chunks_ || bag_.chunks != infos_) {
      throw FileError(file_.path(), end + "the bag has " + std::to_string(chunks_) + " chunks and an index of " +
                                        std::to_string(infos_) + ", but should have " + std::to_string(bag_.chunks) +
                                        ": it was cut off or is damaged");
    }
  }

  BinaryFile& file_;
  RecordSink& sink_;
  BagHeader bag_;
  std::uint32_t chunks_ = 0;
  std::uint32_t infos_ = 0;  ///< of chunks, at the bag's end
};

}  // namespace

void Rosbag1Format::walkFile(BinaryFile& file, RecordSink& sink)
{
  constexpr std::string_view kFirstLine = "#ROSBAG V2.0\n";
  const std::string_view first = file.viewUpTo(0, kFirstLine.size());
  if (first.substr(0, kRosbag1Magic.size()) != kRosbag1Magic) {
    throw FileError(file.path(), "byte 0: is no rosbag");
  }
  if (first != kFirstLine) {
    throw FileError(file.path(), "byte 0: is a rosbag of another version than 2.0: convert it with rosbag fix");
  }
  BagWalk(file, sink).walk(kFirstLine.size());
}

void Rosbag1Format::walkChunk(std::string_view records, const Origin& origin, RecordSink& sink)
{
  ByteReader reader(records, origin);
  while (reader.left() > 0) {
    const std::uint64_t position = reader.position();
    const Origin within{origin.file, origin.part, origin.begin + position};
    const Fields header(reader.counted(), within);
    const std::string_view data = reader.counted();
    const auto opcode = header.number<std::uint8_t>("op");
    if (opcode == kBagConnection) {
      takeConnection(header, {data, within}, sink);
    } else if (opcode == kBagMessageData) {
      const MessageRecord message = messageFrom(header, data);
      sink.message(message.id, message.time, position);
    } else {
      within.fail(0, "a record of kind " + std::to_string(opcode) + " does not belong here: the file is damaged");
    }
  }
}

MessageRecord Rosbag1Format::messageIn(std::string_view records, std::uint64_t position, const Origin& origin) const
{
  ByteReader reader(records, origin);
  reader.skip(position);
  const Fields header(reader.counted(), origin);
  const std::string_view data = reader.counted();
  if (header.number<std::uint8_t>("op") != kBagMessageData) {
    reader.fail("no message begins here, as the index tells: the file is damaged");
  }
  return messageFrom(header, data);
}

MessageRecord Rosbag1Format::messageIn(BinaryFile& file, std::uint64_t position) const
{
  const FileRecord record = recordAt(file, position);
  const Origin origin{file.path(), "", position};
  return messageIn(file.view(position, record.end - position), 0, origin);
}

}  // namespace pcl_floam
