#include "io/pcd_header.h"

#include "io/text.h"

#include <pcl_floam/io/scan_source.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace pcl_floam {

namespace {

using Words = std::vector<std::string_view>;

/// PCL counts points with 32 bits, and signed in places.
constexpr std::uint64_t kMostPoints = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kMostPointBytes = 1U << 16U;

std::string inQuotes(std::string_view word)
{
  constexpr std::size_t kLongest = 40;
  return "'" + std::string(word.substr(0, kLongest)) + (word.size() > kLongest ? "...'" : "'");
}

/// Reads the header line by line.
class HeaderParser {
public:
  HeaderParser(const std::filesystem::path& file, std::string_view content) : file_(file), content_(content) {}

  PcdHeader parse()
  {
    std::string_view rest = content_;
    while (!data_found_) {
      if (rest.empty()) {
        throw FileError(file_, lines_ == 0 ? "the file is empty" : place() + "no DATA line: the header is incomplete");
      }
      const std::string_view line = takeLine(rest);
      ++lines_;
      const Words words = splitWords(line);
      if (!words.empty() && words.front().front() != '#') {
        readEntry(words);
      }
    }
    header_.lines = lines_;
    header_.body_begin = content_.size() - rest.size();
    checkSizes();
    layOutFields();
    return header_;
  }

private:
  [[nodiscard]] std::string place() const { return "line " + std::to_string(lines_) + ": "; }
  [[noreturn]] void fail(const std::string& reason) const { throw FileError(file_, place() + reason); }

  void readEntry(const Words& words)
  {
    const std::string_view key = words.front();
    if (key == "FIELDS" || key == "COLUMNS") {
      readFields(words);
    } else if (key == "SIZE") {
      forEachField(words, [this](PcdField& field, std::string_view word) { field.size = readSize(word); });
    } else if (key == "TYPE") {
      forEachField(words, [this](PcdField& field, std::string_view word) { field.type = readType(word); });
    } else if (key == "COUNT") {
      forEachField(words, [this](PcdField& field, std::string_view word) { field.count = readCount(word); });
    } else if (key == "WIDTH") {
      width_ = readAmount(words);
    } else if (key == "HEIGHT") {
      height_ = readAmount(words);
    } else if (key == "POINTS") {
      points_ = readAmount(words);
    } else if (key == "VIEWPOINT") {
      readViewpoint(words);
    } else if (key == "DATA") {
      readEncoding(words);
    } else if (key != "VERSION") {
      fail(inQuotes(key) + " is no entry of a PCD header");
    }
  }

  void readFields(const Words& words)
  {
    if (words.size() < 2 || !header_.fields.empty()) {
      fail(words.size() < 2 ? "FIELDS names no field" : "FIELDS is given twice");
    }
    for (std::size_t i = 1; i < words.size(); ++i) {
      PcdField field;
      field.name = words[i];
      header_.fields.push_back(field);
    }
  }

  template <typename Read>
  void forEachField(const Words& words, const Read& read)
  {
    if (words.size() - 1 != header_.fields.size()) {
      fail(std::string(words.front()) + " has " + std::to_string(words.size() - 1) + " entries for " +
           std::to_string(header_.fields.size()) + " fields");
    }
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      read(header_.fields[i], words[i + 1]);
    }
  }

  [[nodiscard]] std::uint32_t readSize(std::string_view word) const
  {
    const auto size = parseNumber<std::uint32_t>(word);
    if (!size || (*size != 1 && *size != 2 && *size != 4 && *size != 8)) {
      fail("SIZE " + inQuotes(word) + " is none of 1, 2, 4, 8");
    }
    return *size;
  }

  [[nodiscard]] char readType(std::string_view word) const
  {
    if (word != "F" && word != "I" && word != "U") {
      fail("TYPE " + inQuotes(word) + " is none of F, I, U");
    }
    return word.front();
  }

  [[nodiscard]] std::uint32_t readCount(std::string_view word) const
  {
    const auto count = parseNumber<std::uint32_t>(word);
    if (!count || *count == 0 || *count > kMostPointBytes) {
      fail("COUNT " + inQuotes(word) + " is not between 1 and " + std::to_string(kMostPointBytes));
    }
    return *count;
  }

  [[nodiscard]] std::uint32_t readAmount(const Words& words) const
  {
    const std::string key(words.front());
    if (words.size() != 2) {
      fail(key + " needs one number");
    }
    const auto amount = parseNumber<std::uint64_t>(words[1]);
    if (!amount || *amount > kMostPoints) {
      fail(key + " " + inQuotes(words[1]) + " is not between 0 and " + std::to_string(kMostPoints));
    }
    return static_cast<std::uint32_t>(*amount);
  }

  void readViewpoint(const Words& words)
  {
    if (words.size() != 8) {
      fail("VIEWPOINT needs 7 numbers");
    }
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto number = parseNumber<double>(words[i]);
      if (!number) {
        fail("VIEWPOINT: " + inQuotes(words[i]) + " is no number");
      }
      if (i <= 3) {
        header_.viewpoint[static_cast<Eigen::Index>(i) - 1] = *number;
      }
    }
  }

  void readEncoding(const Words& words)
  {
    const std::string_view name = words.size() == 2 ? words[1] : std::string_view();
    if (name == "ascii") {
      header_.encoding = PcdEncoding::ascii;
    } else if (name == "binary") {
      header_.encoding = PcdEncoding::binary;
    } else if (name == "binary_compressed") {
      header_.encoding = PcdEncoding::binary_compressed;
    } else {
      fail("DATA " + inQuotes(name) + " is none of ascii, binary, binary_compressed");
    }
    data_found_ = true;
  }

  void checkSizes()
  {
    if (!width_ && !points_) {
      fail("the header has neither WIDTH nor POINTS");
    }
    header_.width = width_ ? *width_ : *points_;
    header_.height = height_.value_or(1);
    if (header_.points() > kMostPoints) {
      fail("WIDTH times HEIGHT is more than " + std::to_string(kMostPoints));
    }
    if (points_ && *points_ != header_.points()) {
      fail("WIDTH times HEIGHT is " + std::to_string(header_.points()) + ", but POINTS is " + std::to_string(*points_));
    }
  }

  void layOutFields()
  {
    if (header_.encoding == PcdEncoding::binary_compressed) {
      const auto isPadding = [](const PcdField& field) { return field.isPadding(); };
      header_.fields.erase(std::remove_if(header_.fields.begin(), header_.fields.end(), isPadding),
                           header_.fields.end());
    }
    std::uint64_t offset = 0;
    for (PcdField& field : header_.fields) {
      if (field.type == 'F' && field.size < 4) {
        fail("field " + inQuotes(field.name) + ": there is no floating-point number of " + std::to_string(field.size) +
             " bytes");
      }
      field.offset = static_cast<std::uint32_t>(offset);
      offset += field.bytes();
      if (offset > kMostPointBytes) {
        fail("a point has more than " + std::to_string(kMostPointBytes) + " bytes");
      }
    }
    header_.point_bytes = static_cast<std::uint32_t>(offset);
    if (offset * header_.width > std::numeric_limits<std::uint32_t>::max()) {
      fail("a row of points has more bytes than PCL can count");
    }
    for (const char* name : {"x", "y", "z"}) {
      checkCoordinate(name);
    }
  }

  void checkCoordinate(std::string_view name) const
  {
    const auto field = std::find_if(header_.fields.begin(), header_.fields.end(),
                                    [name](const PcdField& candidate) { return candidate.name == name; });
    if (field == header_.fields.end()) {
      fail("the points have no field " + inQuotes(name));
    }
    if (field->type != 'F' || field->count != 1) {
      fail("field " + inQuotes(name) + " is not one float32 or float64 (TYPE F, SIZE 4 or 8, COUNT 1)");
    }
  }

  const std::filesystem::path& file_;
  std::string_view content_;
  PcdHeader header_;
  std::size_t lines_ = 0;
  std::optional<std::uint32_t> width_;
  std::optional<std::uint32_t> height_;
  std::optional<std::uint32_t> points_;
  bool data_found_ = false;
};

}  // namespace

PcdHeader parsePcdHeader(const std::filesystem::path& file, std::string_view content)
{
  return HeaderParser(file, content).parse();
}

}  // namespace pcl_floam
