#include "io/message_scans.h"

#include "io/decompression.h"
#include "io/messages/scan_messages.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_floam {

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::optional<MessageEncoding> encodingOf(const std::string& name)
{
  if (name == "ros1") {
    return MessageEncoding::ros1;
  }
  return name == "cdr" ? std::optional<MessageEncoding>(MessageEncoding::cdr) : std::nullopt;
}

/// The scans of one topic of several recordings.
class MessageScans : public ScanReader {
public:
  MessageScans(Recordings recordings, ScanFormat format, const std::string& topic,
               std::shared_ptr<const VelodyneCalibration> calibration)
      : recordings_(std::move(recordings)), format_(format), topic_(topic), calibration_(std::move(calibration))
  {
    for (const auto& recording : recordings_) {
      const std::vector<RecordedTopic>& topics = recording->topics();
      const auto found =
          std::find_if(topics.begin(), topics.end(), [&](const RecordedTopic& t) { return t.name == topic; });
      recording->select(found == topics.end() ? kNone : static_cast<std::size_t>(found - topics.begin()));
      types_.push_back(found == topics.end() ? RecordedTopic() : *found);
      ends_.push_back((ends_.empty() ? 0 : ends_.back()) + recording->size());
    }
  }

  [[nodiscard]] ScanFormat format() const override { return format_; }
  [[nodiscard]] std::size_t size() const override { return ends_.back(); }
  [[nodiscard]] const std::filesystem::path& path(std::size_t i) const override
  {
    return recordings_[place(i).recording]->path();
  }

  [[nodiscard]] std::string name(std::size_t i) const override
  {
    return path(i).filename().string() + " scan " + std::to_string(i);
  }

  [[nodiscard]] std::optional<double> stamp(std::size_t i) override
  {
    MessageReader message = messageOf(i);
    const double stamp = takeHeader(message).stamp;
    return stamp > 0.0 ? stamp : recorded_;
  }

  void read(std::size_t i, pcl::PCLPointCloud2& cloud) override
  {
    MessageReader message = messageOf(i);
    decoderOf(types_[last_].type).value()(message, calibration_.get(), cloud);
  }

  /// Looks at the first scan, for what makes all of them unreadable. A damage is told when the scan is asked for.
  /// \throws UnreadableKind
  void checkKind()
  {
    try {
      pcl::PCLPointCloud2 cloud;
      read(0, cloud);
    } catch (const UnreadableKind&) {
      throw;
    } catch (const FileError&) {
      return;
    }
  }

private:
  struct Place {
    std::size_t recording = 0;
    std::size_t message = 0;
  };

  [[nodiscard]] Place place(std::size_t i) const
  {
    const auto end = std::upper_bound(ends_.begin(), ends_.end(), i);
    if (end == ends_.end()) {
      throw std::out_of_range("the recording has no scan " + std::to_string(i));
    }
    return {static_cast<std::size_t>(end - ends_.begin()), i - (end == ends_.begin() ? 0 : *std::prev(end))};
  }

  /// The message of scan \p i, valid until the next.
  [[nodiscard]] MessageReader messageOf(std::size_t i)
  {
    const Place at = place(i);
    if (last_ != at.recording && last_ < recordings_.size()) {
      recordings_[last_]->rest();
    }
    last_ = at.recording;
    const RecordedTopic& topic = types_[at.recording];
    RecordedMessage recorded = recordings_[at.recording]->read(at.message);
    recorded_ = recorded.time;
    origin_ = {recordings_[at.recording]->path(), "topic " + topic_ + ", " + recorded.origin, 0};
    if (topic.encoding == "cdr" && isZstd(recorded.data)) {  // no CDR begins so
      decompressZstd(recorded.data, origin_, unpacked_);
      recorded.data = unpacked_;
    }
    return {recorded.data, encodingOf(topic.encoding).value(), origin_};
  }

  Recordings recordings_;
  ScanFormat format_;
  std::string topic_;
  std::shared_ptr<const VelodyneCalibration> calibration_;  ///< of an HDL-64
  std::vector<RecordedTopic> types_;                        ///< of each recording
  std::vector<std::size_t> ends_;                           ///< number of scans up to each recording's end
  std::size_t last_ = kNone;
  double recorded_ = 0.0;  ///< s; when the last message was
  Origin origin_;
  std::string unpacked_;
};

bool hasScans(const RecordedTopic& topic)
{
  return decoderOf(topic.type).has_value() && encodingOf(topic.encoding).has_value();
}

std::string listed(const std::vector<ScanTopic>& topics)
{
  constexpr std::size_t kMost = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, topics.size()); ++i) {
    text += (i == 0 ? "" : ", ") + topics[i].name + " (" + (topics[i].type.empty() ? "no type" : topics[i].type) +
            ", " + std::to_string(topics[i].messages) + " messages)";
  }
  return topics.size() <= kMost ? text : text + ", and " + std::to_string(topics.size() - kMost) + " more";
}

/// Why the first recording ends before its end.
std::optional<FileError> damageOf(const Recordings& recordings)
{
  for (const auto& recording : recordings) {
    recording->select(kNone);
    try {
      if (recording->size() > 0) {
        (void)recording->read(0);
      }
    } catch (const FileError& error) {
      return error;
    }
  }
  return std::nullopt;
}

/// The same, to be told beside what was not found.
std::string damageIn(const Recordings& recordings)
{
  const std::optional<FileError> damage = damageOf(recordings);
  return damage ? std::string("; and it is damaged: ") + damage->what() : "";
}

std::string chooseTopic(const std::filesystem::path& input, const Recordings& recordings, const std::string& topic)
{
  std::vector<ScanTopic> all = topicsOf(recordings);
  if (all.empty()) {
    const std::optional<FileError> damage = damageOf(recordings);
    throw damage ? FileError(*damage) : FileError(input, "is empty: no topic was recorded");
  }
  std::vector<ScanTopic> scans;
  std::copy_if(all.begin(), all.end(), std::back_inserter(scans), [](const ScanTopic& t) { return t.has_scans; });
  if (!topic.empty()) {
    const auto same = [&](const ScanTopic& candidate) { return candidate.name == topic; };
    const auto found = std::find_if(all.begin(), all.end(), same);
    if (found == all.end()) {
      throw FileError(input, "has no topic '" + topic + "'. Topics of scans: " +
                                 (scans.empty() ? "none" : listed(scans)) + damageIn(recordings));
    }
    if (!found->has_scans) {
      throw FileError(input, "topic '" + topic + "' is of type " + found->type +
                                 ", which holds no scans that are read (PointCloud2, CustomMsg, VelodyneScan)");
    }
    return topic;
  }
  if (scans.empty()) {
    throw FileError(input,
                    "has no topic with scans (PointCloud2, CustomMsg, VelodyneScan): record the lidar's, too. "
                    "Its topics: " +
                        listed(all) + damageIn(recordings));
  }
  if (scans.size() > 1) {
    throw FileError(input,
                    "has several topics of scans; choose one with --topic (or the argument topic): " + listed(scans));
  }
  return scans.front().name;
}

}  // namespace

std::vector<ScanTopic> topicsOf(const Recordings& recordings)
{
  std::vector<ScanTopic> topics;
  for (const auto& recording : recordings) {
    for (const RecordedTopic& topic : recording->topics()) {
      const auto same = std::find_if(topics.begin(), topics.end(),
                                     [&](const ScanTopic& t) { return t.name == topic.name && t.type == topic.type; });
      if (same == topics.end()) {
        topics.push_back({topic.name, topic.type, topic.messages, hasScans(topic)});
      } else {
        same->messages += topic.messages;
      }
    }
  }
  return topics;
}

std::unique_ptr<ScanReader> openMessages(const std::filesystem::path& input, Recordings recordings, ScanFormat format,
                                         const std::string& topic,
                                         std::shared_ptr<const VelodyneCalibration> calibration)
{
  const std::string chosen = chooseTopic(input, recordings, topic);
  for (const ScanTopic& candidate : calibration ? topicsOf(recordings) : std::vector<ScanTopic>()) {
    if (candidate.name == chosen && !holdsVelodynePackets(candidate.type)) {
      throw FileError(input, "topic '" + chosen + "' is of type " + candidate.type +
                                 ", which needs no calibration: leave --calibration out");
    }
  }
  auto scans = std::make_unique<MessageScans>(std::move(recordings), format, chosen, std::move(calibration));
  if (scans->size() == 0) {
    throw FileError(input, "topic '" + chosen + "' has no message: the lidar sent none while this was recorded");
  }
  scans->checkKind();
  return scans;
}

}  // namespace pcl_floam
