// What an input is, and who reads it.

#include "io/binary_file.h"
#include "io/message_scans.h"
#include "io/recordings/chunked_recording.h"
#include "io/recordings/mcap_format.h"
#include "io/recordings/rosbag1_format.h"
#include "io/scan_reader.h"

#include <system_error>

namespace pcl_floam {

namespace fs = std::filesystem;

namespace {

/// A recording's messages, or nothing if the input is no recording of messages.
struct MessageInput {
  Recordings recordings;
  ScanFormat format = ScanFormat::pcd;
};

bool beginsWith(std::string_view bytes, std::string_view magic)
{
  return bytes.substr(0, magic.size()) == magic;
}

template <typename Format>
MessageInput chunked(const fs::path& file, ScanFormat format)
{
  MessageInput input;
  input.recordings.push_back(std::make_unique<ChunkedRecording>(file, std::make_unique<Format>()));
  input.format = format;
  return input;
}

/// By its first bytes: many files have other names than they should.
MessageInput openRecordings(const fs::path& input)
{
  constexpr std::uint64_t kLongestMagic = 16;
  std::error_code error;
  if (fs::is_directory(input, error)) {
    return {};
  }
  const std::string magic(BinaryFile(input).viewUpTo(0, kLongestMagic));
  if (beginsWith(magic, kMcapMagic)) {
    return chunked<McapFormat>(input, ScanFormat::mcap);
  }
  if (beginsWith(magic, kRosbag1Magic)) {
    return chunked<Rosbag1Format>(input, ScanFormat::rosbag1);
  }
  return {};
}

}  // namespace

std::unique_ptr<ScanReader> openScans(const fs::path& input, const std::string& topic)
{
  std::error_code error;
  if (!fs::exists(input, error)) {
    throw FileError(input, error ? "cannot be read: " + error.message() : "no such folder or file");
  }
  MessageInput messages = openRecordings(input);
  if (!messages.recordings.empty()) {
    return openMessages(input, std::move(messages.recordings), messages.format, topic);
  }
  if (!topic.empty()) {
    throw FileError(input, "has no topics: --topic (or the argument topic) is for recordings");
  }
  return fs::is_directory(input, error) ? openFolder(input) : openScanFile(input);
}

std::vector<ScanTopic> listTopics(const fs::path& input)
{
  return topicsOf(openRecordings(input).recordings);
}

}  // namespace pcl_floam
