/// \file recording.h
/// A file of messages by topic, of whatever format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pcl_floam {

inline constexpr double kSecondsPerNanosecond = 1e-9;

/// What a recording says of a topic.
struct RecordedTopic {
  std::string name;
  std::string type;      ///< for example sensor_msgs/msg/PointCloud2
  std::string encoding;  ///< of its messages: ros1 or cdr, or one that is not read
  std::uint64_t messages = 0;
};

/// One message, as bytes that are valid until the next is read.
struct RecordedMessage {
  std::string_view data;
  double time = 0.0;   ///< s; when it was recorded
  std::string origin;  ///< where it lies in the file, for messages of failures
};

/// Messages of one topic, in the order in which they were recorded.
///
/// A place where the file is damaged or cut off counts as a message: reading it fails with the reason. So whoever reads
/// all messages is told of what is missing, after what came before.
class Recording {
public:
  Recording() = default;
  virtual ~Recording() = default;
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] virtual const std::filesystem::path& path() const = 0;
  [[nodiscard]] virtual const std::vector<RecordedTopic>& topics() const = 0;

  /// Chooses the topic that size() and read() speak of, by its place among topics(); with none that only failures are
  /// left: the places where the file is damaged.
  virtual void select(std::size_t topic) = 0;
  [[nodiscard]] virtual std::size_t size() const = 0;

  /// \throws FileError if the message cannot be read.
  [[nodiscard]] virtual RecordedMessage read(std::size_t i) = 0;

  /// Gives up what is kept in memory of the message that was read last.
  virtual void rest() = 0;

  /// Takes care of what must last as long as the recording: the folder that it was unpacked to.
  void keep(std::shared_ptr<const void> what) { kept_ = std::move(what); }

private:
  std::shared_ptr<const void> kept_;
};

}  // namespace pcl_floam
