#include "io/recordings/chunked_recording.h"

#include "io/crc32.h"

#include <algorithm>
#include <utility>

namespace pcl_floam {

namespace {

/// The messages of some topics in one chunk.
class ChunkMessages : public RecordSink {
public:
  explicit ChunkMessages(const std::set<std::uint32_t>& ids) : ids_(ids) {}

  void topic(std::uint32_t, const RecordedTopic&) override {}
  void chunk(const ChunkPlace&) override {}
  void indexEntry(std::uint32_t, std::uint64_t, std::uint64_t) override {}
  void message(std::uint32_t id, std::uint64_t, std::uint64_t position) override
  {
    if (ids_.count(id) > 0) {
      positions.push_back(position);
    }
  }

  std::vector<std::uint64_t> positions;

private:
  const std::set<std::uint32_t>& ids_;
};

}  // namespace

/// Counts the messages of each topic, and keeps the places of those of the topic that is selected.
class ChunkedRecording::Collector : public RecordSink {
public:
  explicit Collector(ChunkedRecording& recording) : r_(recording) {}

  void topic(std::uint32_t id, const RecordedTopic& topic) override { topics[id] = topic; }

  void chunk(const ChunkPlace& chunk) override
  {
    finishChunk();
    pending_ = chunk;
    indexed_ = false;
  }

  void indexEntry(std::uint32_t id, std::uint64_t time, std::uint64_t position) override
  {
    if (pending_ && r_.trust_index_) {
      indexed_ = true;
      add(id, time, position, nextChunk());
    }
  }

  void message(std::uint32_t id, std::uint64_t time, std::uint64_t position) override
  {
    if (!inside_) {
      finishChunk();
    }
    add(id, time, position, inside_ ? nextChunk() : kNoChunk);
  }

  /// The chunk that was told last, if its index has not told what is in it.
  void finishChunk()
  {
    if (!pending_) {
      return;
    }
    const Chunk chunk{*pending_, indexed_, r_.entries_.size() - kept_};
    std::optional<FileError> problem = indexed_ ? std::nullopt : lookInto(chunk.place);
    pending_.reset();
    if (kept_ > 0) {
      std::sort(r_.entries_.begin() + static_cast<std::ptrdiff_t>(chunk.first_entry), r_.entries_.end(),
                [](const Entry& a, const Entry& b) { return a.position < b.position; });
      r_.chunks_.push_back(chunk);
      kept_ = 0;
    }
    if (problem) {
      damage(*problem);
    }
  }

  void damage(const FileError& error)
  {
    r_.entries_.push_back({0, r_.damages_.size(), kDamage});
    r_.damages_.push_back(error);
  }

  std::map<std::uint32_t, RecordedTopic> topics;
  std::map<std::uint32_t, std::uint64_t> counts;

private:
  /// \return what is wrong with the chunk, of which all before it has been told
  std::optional<FileError> lookInto(const ChunkPlace& chunk)
  {
    std::optional<FileError> problem;
    inside_ = true;
    try {
      r_.format_->walkChunk(r_.unpack(chunk), r_.originOf(chunk), *this);
    } catch (const FileError& error) {
      // Of a chunk that is cut off, the end of the file tells.
      problem = chunk.whole ? std::optional<FileError>(error) : std::nullopt;
    }
    inside_ = false;
    return problem;
  }

  [[nodiscard]] std::uint32_t nextChunk() const { return static_cast<std::uint32_t>(r_.chunks_.size()); }

  void add(std::uint32_t id, std::uint64_t time, std::uint64_t position, std::uint32_t chunk)
  {
    ++counts[id];
    if (r_.selected_.count(id) > 0) {
      r_.entries_.push_back({time, position, chunk});
      kept_ += chunk == kNoChunk ? 0 : 1;
    }
  }

  ChunkedRecording& r_;
  std::optional<ChunkPlace> pending_;
  bool indexed_ = false;
  bool inside_ = false;
  std::size_t kept_ = 0;  ///< entries of the pending chunk
};

ChunkedRecording::ChunkedRecording(std::filesystem::path path, std::unique_ptr<RecordFormat> format)
    : file_(path), chunk_file_(std::move(path)), format_(std::move(format))
{
  survey();
}

void ChunkedRecording::survey()
{
  entries_.clear();
  damages_.clear();
  Collector collector(*this);
  walk(collector);
  const auto nameless = [&](const auto& count) { return collector.topics.count(count.first) == 0; };
  if (trust_index_ && std::any_of(collector.counts.begin(), collector.counts.end(), nameless)) {
    trust_index_ = false;  // the topics are told within the chunks only: the recording was cut off
    return survey();
  }
  for (const auto& [id, topic] : collector.topics) {
    auto same = std::find_if(topics_.begin(), topics_.end(), [&topic = topic](const RecordedTopic& other) {
      return other.name == topic.name && other.type == topic.type && other.encoding == topic.encoding;
    });
    same = same == topics_.end() ? topics_.insert(same, topic) : same;
    same->messages += collector.counts[id];
    topic_of_id_[id] = static_cast<std::size_t>(same - topics_.begin());
  }
}

void ChunkedRecording::walk(Collector& collector)
{
  try {
    format_->walkFile(file_, collector);
    collector.finishChunk();
  } catch (const FileError& error) {
    collector.finishChunk();
    collector.damage(error);
  }
}

void ChunkedRecording::select(std::size_t topic)
{
  selected_.clear();
  chunks_.clear();
  entries_.clear();
  damages_.clear();
  loaded_.reset();
  for (const auto& [id, of_topic] : topic_of_id_) {
    if (of_topic == topic) {
      selected_.insert(id);
    }
  }
  Collector collector(*this);
  walk(collector);
}

Origin ChunkedRecording::originOf(const ChunkPlace& chunk) const
{
  return {file_.path(), "chunk at byte " + std::to_string(chunk.position) + ", ", 0};
}

std::string_view ChunkedRecording::unpack(const ChunkPlace& chunk)
{
  loaded_.reset();
  const Origin origin = originOf(chunk);
  std::string_view records = chunk_file_.view(chunk.data, chunk.packed);
  if (chunk.compression != Compression::none) {
    decompress(chunk.compression, records, chunk.size, chunk.whole, origin, unpacked_);
    records = unpacked_;
  } else if (chunk.whole && chunk.size != chunk.packed) {
    origin.fail(0,
                "it should be of " + std::to_string(chunk.size) + " bytes, but is of " + std::to_string(chunk.packed));
  }
  if (chunk.whole && chunk.crc != 0 && crc32(records) != chunk.crc) {
    origin.fail(0, "its checksum (CRC-32) is not that of its bytes: it is damaged");
  }
  return records;
}

void ChunkedRecording::load(std::uint32_t chunk)
{
  if (loaded_ != chunk) {
    records_ = unpack(chunks_.at(chunk).place);
    if (chunks_[chunk].indexed) {
      compareWithIndex(chunk);
    }
    loaded_ = chunk;
  }
}

void ChunkedRecording::compareWithIndex(std::uint32_t chunk)
{
  const Origin origin = originOf(chunks_[chunk].place);
  ChunkMessages found(selected_);
  format_->walkChunk(records_, origin, found);
  std::size_t i = chunks_[chunk].first_entry;
  const auto told = [&] { return i < entries_.size() && entries_[i].chunk == chunk; };
  for (const std::uint64_t position : found.positions) {
    if (!told() || entries_[i].position != position) {
      origin.fail(position, "the index does not tell this message: the file is damaged");
    }
    ++i;
  }
  if (told()) {
    origin.fail(entries_[i].position, "the index tells a message that is not there: the file is damaged");
  }
}

RecordedMessage ChunkedRecording::read(std::size_t i)
{
  const Entry& entry = entries_.at(i);
  if (entry.chunk == kDamage) {
    throw FileError(damages_.at(entry.position));
  }
  const double time = kSecondsPerNanosecond * static_cast<double>(entry.time);
  if (entry.chunk == kNoChunk) {
    return {format_->messageIn(file_, entry.position).data, time,
            "message at byte " + std::to_string(entry.position) + ", "};
  }
  load(entry.chunk);
  const Origin origin = originOf(chunks_[entry.chunk].place);
  return {format_->messageIn(records_, entry.position, origin).data, time,
          origin.part + "message at byte " + std::to_string(entry.position) + " of it, "};
}

void ChunkedRecording::rest()
{
  loaded_.reset();
  unpacked_ = std::string();
  file_.forget();
  chunk_file_.forget();
}

}  // namespace pcl_floam
