// What an input is, and who reads it.

#include "io/binary_file.h"
#include "io/message_scans.h"
#include "io/recordings/chunked_recording.h"
#include "io/recordings/mcap_format.h"
#include "io/recordings/rosbag1_format.h"
#include "io/recordings/rosbag2_folder.h"
#include "io/recordings/sqlite_recording.h"
#include "io/scan_reader.h"
#include "io/temporary_place.h"
#include "io/velodyne/pcap_scans.h"

#include <system_error>
#include <utility>

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

/// A named file of a rosbag2 that cannot be opened: one scan that cannot be read.
class MissingRecording : public Recording {
public:
  explicit MissingRecording(const FileError& reason) { reason_ = reason; }
  [[nodiscard]] const fs::path& path() const override { return reason_->path(); }
  [[nodiscard]] const std::vector<RecordedTopic>& topics() const override { return topics_; }
  void select(std::size_t) override {}
  [[nodiscard]] std::size_t size() const override { return 1; }
  [[nodiscard]] RecordedMessage read(std::size_t) override { throw FileError(reason_.value()); }
  void rest() override {}

private:
  std::optional<FileError> reason_;
  std::vector<RecordedTopic> topics_;
};

std::string magicOf(const fs::path& file)
{
  constexpr std::uint64_t kLongestMagic = 16;
  return std::string(BinaryFile(file).viewUpTo(0, kLongestMagic));
}

/// By its first bytes: many files have other names than they should. Nothing if it is no recording of messages.
std::unique_ptr<Recording> openRecording(const fs::path& file, ScanFormat& format)
{
  const std::string magic = magicOf(file);
  if (beginsWith(magic, kMcapMagic)) {
    format = ScanFormat::mcap;
    return std::make_unique<ChunkedRecording>(file, std::make_unique<McapFormat>());
  }
  if (beginsWith(magic, kRosbag1Magic)) {
    format = ScanFormat::rosbag1;
    return std::make_unique<ChunkedRecording>(file, std::make_unique<Rosbag1Format>());
  }
  if (beginsWith(magic, kSqliteMagic)) {
    format = ScanFormat::rosbag2;
    return openSqlite(file);
  }
  if (isZstd(magic)) {
    auto place = std::make_shared<TemporaryPlace>();
    const fs::path unpacked = place->path() / file.stem();
    decompressZstdFile(file, unpacked);
    std::unique_ptr<Recording> recording = isZstd(magicOf(unpacked)) ? nullptr : openRecording(unpacked, format);
    if (recording) {
      recording->keep(std::move(place));
    }
    return recording;
  }
  return nullptr;
}

MessageInput openRecordings(const fs::path& input)
{
  MessageInput opened;
  std::error_code error;
  if (!fs::is_directory(input, error)) {
    if (auto recording = openRecording(input, opened.format)) {
      opened.recordings.push_back(std::move(recording));
    }
    return opened;
  }
  bool any = false;
  for (const fs::path& file : rosbag2Files(input)) {
    try {
      auto recording = openRecording(file, opened.format);
      any |= recording != nullptr;
      opened.recordings.push_back(recording ? std::move(recording)
                                            : std::make_unique<MissingRecording>(FileError(file, "is no recording")));
    } catch (const FileError& problem) {
      opened.recordings.push_back(std::make_unique<MissingRecording>(problem));
    }
  }
  if (!any && !opened.recordings.empty()) {
    (void)opened.recordings.front()->read(0);  // tells why none can be opened
  }
  opened.format = opened.format == ScanFormat::rosbag1 ? ScanFormat::rosbag1 : ScanFormat::rosbag2;
  return opened;
}

}  // namespace

std::unique_ptr<ScanReader> openScans(const fs::path& input, const ScanSourceOptions& options)
{
  std::error_code error;
  if (!fs::exists(input, error)) {
    throw FileError(input, error ? "cannot be read: " + error.message() : "no such folder or file");
  }
  std::shared_ptr<const VelodyneCalibration> calibration;
  if (!options.calibration.empty()) {
    calibration = std::make_shared<VelodyneCalibration>(readVelodyneCalibration(options.calibration));
  }
  MessageInput messages = openRecordings(input);
  if (!messages.recordings.empty()) {
    return openMessages(input, std::move(messages.recordings), messages.format, options.topic, std::move(calibration));
  }
  const bool is_folder = fs::is_directory(input, error);
  if (!is_folder && isCapture(magicOf(input))) {
    return openCapture(input, options.topic, std::move(calibration));
  }
  if (!options.topic.empty()) {
    throw FileError(input, "has no topics: --topic (or the argument topic) is for recordings");
  }
  if (calibration) {
    throw FileError(input, "has no packets of a Velodyne: --calibration is for recordings of an HDL-64's");
  }
  return is_folder ? openFolder(input) : openScanFile(input);
}

std::vector<ScanTopic> listTopics(const fs::path& input)
{
  std::error_code error;
  if (!fs::is_directory(input, error) && isCapture(magicOf(input))) {
    return sendersIn(input);
  }
  return topicsOf(openRecordings(input).recordings);
}

}  // namespace pcl_floam
