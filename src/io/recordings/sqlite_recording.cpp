#include "io/recordings/sqlite_recording.h"

#include "io/binary_file.h"
#include "io/temporary_place.h"

#include <optional>
#include <utility>

#ifdef PCL_FLOAM_WITH_SQLITE
#include <sqlite3.h>
#endif

namespace pcl_floam {

namespace fs = std::filesystem;

#ifndef PCL_FLOAM_WITH_SQLITE

std::unique_ptr<Recording> openSqlite(const fs::path& file)
{
  throw FileError(file,
                  "is a rosbag2 (SQLite), which this build left out: install libsqlite3-dev and configure "
                  "pcl_floam again");
}

#else

namespace {

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;

/// One SQL statement and its results, row by row.
class Statement {
public:
  Statement(sqlite3* database, const char* sql, const fs::path& file) : database_(database), file_(file)
  {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database_, sql, -1, &raw, nullptr) != SQLITE_OK) {
      fail();
    }
    statement_.reset(raw);
  }

  void bind(int parameter, std::int64_t value)
  {
    sqlite3_reset(statement_.get());
    sqlite3_bind_int64(statement_.get(), parameter, value);
  }

  /// \return whether there is another row \throws FileError if the database is damaged
  [[nodiscard]] bool next()
  {
    const int status = sqlite3_step(statement_.get());
    if (status != SQLITE_ROW && status != SQLITE_DONE) {
      fail();
    }
    return status == SQLITE_ROW;
  }

  [[nodiscard]] std::int64_t number(int column) const { return sqlite3_column_int64(statement_.get(), column); }

  /// A text's or a blob's bytes, valid until the next row.
  [[nodiscard]] std::string_view bytes(int column) const
  {
    const auto* begin = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
    const int size = sqlite3_column_bytes(statement_.get(), column);
    return begin == nullptr ? std::string_view() : std::string_view(begin, static_cast<std::size_t>(size));
  }

  void reset() { sqlite3_reset(statement_.get()); }

private:
  [[noreturn]] void fail() const
  {
    throw FileError(
        file_, std::string("SQLite says: ") + sqlite3_errmsg(database_) + ": the recording is damaged or was cut off");
  }

  sqlite3* database_;
  const fs::path& file_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_{nullptr, sqlite3_finalize};
};

/// A path as SQLite's URIs have it.
std::string asUri(const fs::path& file, const char* choices)
{
  std::string uri = "file:";
  for (const char c : fs::absolute(file).string()) {
    constexpr std::string_view kSpecial = "?#%";
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    if (kSpecial.find(c) == std::string_view::npos) {
      uri += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      uri += {'%', kDigits[byte / 16U], kDigits[byte % 16U]};
    }
  }
  return uri + choices;
}

Database openDatabase(const fs::path& file, const char* choices)
{
  sqlite3* raw = nullptr;
  const int status =
      sqlite3_open_v2(asUri(file, choices).c_str(), &raw, SQLITE_OPEN_READWRITE | SQLITE_OPEN_URI, nullptr);
  Database database(raw, sqlite3_close);
  if (status != SQLITE_OK) {
    throw FileError(file, std::string("cannot be opened: ") + sqlite3_errmsg(raw));
  }
  // Else SQLite gives nothing at all of a file that is shorter than it says.
  sqlite3_exec(database.get(), "PRAGMA writable_schema=ON", nullptr, nullptr, nullptr);
  return database;
}

class SqliteRecording : public Recording {
public:
  explicit SqliteRecording(const fs::path& file) : path_(file), database_(nullptr, sqlite3_close)
  {
    open();
    findTopics();
  }

  [[nodiscard]] const fs::path& path() const override { return path_; }
  [[nodiscard]] const std::vector<RecordedTopic>& topics() const override { return topics_; }
  [[nodiscard]] std::size_t size() const override { return entries_.size() + (damage_ ? 1 : 0); }
  void rest() override { read_->reset(); }

  void select(std::size_t topic) override
  {
    entries_.clear();
    damage_ = shortage();
    try {
      Statement messages(database_.get(), "SELECT id, timestamp FROM messages WHERE topic_id = ?1 ORDER BY id", path_);
      messages.bind(1, topic < ids_.size() ? ids_[topic] : -1);
      while (messages.next()) {
        entries_.push_back({messages.number(0), messages.number(1)});
      }
    } catch (const FileError& error) {
      damage_ = error;
    }
  }

  [[nodiscard]] RecordedMessage read(std::size_t i) override
  {
    if (i == entries_.size() && damage_) {
      throw FileError(*damage_);
    }
    const Entry& entry = entries_.at(i);
    read_->bind(1, entry.id);
    if (!read_->next()) {
      throw FileError(path_, "message " + std::to_string(entry.id) + " is gone: the recording is damaged");
    }
    return {read_->bytes(0), kSecondsPerNanosecond * static_cast<double>(entry.time),
            "message " + std::to_string(entry.id) + ", "};
  }

private:
  struct Entry {
    std::int64_t id = 0;
    std::int64_t time = 0;  ///< ns
  };

  void open()
  {
    bool unfinished = false;
    for (const char* ending : {"-wal", "-journal"}) {
      std::error_code error;
      const auto size = fs::file_size(path_.string() + ending, error);
      unfinished |= !error && size > 0;
    }
    // What is not written by anybody needs neither locks nor files beside it.
    database_ = unfinished ? openCopy() : openDatabase(path_, "?mode=ro&immutable=1");
  }

  /// Folding in what lies beside the file changes it, and so does even reading: SQLite leaves a file there.
  Database openCopy()
  {
    copy_ = std::make_unique<TemporaryPlace>();
    for (const char* ending : {"", "-wal", "-journal"}) {
      std::error_code error;
      const fs::path from = path_.string() + ending;
      if (fs::exists(from, error) &&
          !fs::copy_file(from, copy_->path() / from.filename(), fs::copy_options::none, error)) {
        throw FileError(from, "cannot be copied to " + copy_->path().string() + ": " + error.message());
      }
    }
    fs::permissions(copy_->path() / path_.filename(), fs::perms::owner_read | fs::perms::owner_write);
    return openDatabase(copy_->path() / path_.filename(), "?mode=rw");
  }

  void findTopics()
  {
    Statement topics(database_.get(), "SELECT id, name, type, serialization_format FROM topics ORDER BY id", path_);
    try {
      while (topics.next()) {
        ids_.push_back(topics.number(0));
        topics_.push_back(
            {std::string(topics.bytes(1)), std::string(topics.bytes(2)), std::string(topics.bytes(3)), 0});
      }
      countMessages();
    } catch (const FileError&) {
      // Where it is damaged, the messages will tell.
    }
    read_ = std::make_unique<Statement>(database_.get(), "SELECT data FROM messages WHERE id = ?1", path_);
  }

  void countMessages()
  {
    Statement counts(database_.get(), "SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id", path_);
    while (counts.next()) {
      for (std::size_t t = 0; t < ids_.size(); ++t) {
        topics_[t].messages += ids_[t] == counts.number(0) ? static_cast<std::uint64_t>(counts.number(1)) : 0;
      }
    }
  }

  /// What is wrong if the file has less pages than it says. SQLite would tell only if it met one of them.
  [[nodiscard]] std::optional<FileError> shortage() const
  {
    BinaryFile file(copy_ ? copy_->path() / path_.filename() : path_);
    const std::string head(file.viewUpTo(0, 100));
    const auto big = [&head](std::size_t place, std::size_t bytes) {
      std::uint64_t number = 0;
      for (std::size_t i = place; i < place + bytes && i < head.size(); ++i) {
        number = 256U * number + static_cast<std::uint8_t>(head[i]);
      }
      return number;
    };
    const std::uint64_t page = big(16, 2) == 1 ? 65536 : big(16, 2);
    const std::uint64_t said = big(24, 4) == big(92, 4) ? page * big(28, 4) : 0;
    if (copy_ || said <= file.size()) {
      return std::nullopt;
    }
    return FileError(path_, "byte " + std::to_string(file.size()) + ": the file should be of " + std::to_string(said) +
                                " bytes: the recording was cut off, what followed is missing");
  }

  fs::path path_;
  std::unique_ptr<TemporaryPlace> copy_;
  Database database_;
  std::unique_ptr<Statement> read_;
  std::vector<RecordedTopic> topics_;
  std::vector<std::int64_t> ids_;
  std::vector<Entry> entries_;
  std::optional<FileError> damage_;
};

}  // namespace

std::unique_ptr<Recording> openSqlite(const fs::path& file)
{
  return std::make_unique<SqliteRecording>(file);
}

#endif

}  // namespace pcl_floam
