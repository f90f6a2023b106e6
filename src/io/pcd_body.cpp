// PCL's own PCDReader is not used: it prints to the console, tells neither place nor reason of a failure, turns words
// that are no numbers into zeros, and accepts compressed files with less data than their header promises.

#include "io/pcd_body.h"

#include "io/text.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/io/scan_source.h>

#include <pcl/io/lzf.h>

#include <cstring>
#include <limits>

namespace pcl_floam {

namespace {

[[noreturn]] void failAtByte(const std::filesystem::path& file, std::size_t byte, const std::string& reason)
{
  throw FileError(file, "byte " + std::to_string(byte) + ": " + reason);
}

void readBinary(const std::filesystem::path& file, const PcdHeader& header, std::string_view content,
                pcl::PCLPointCloud2& cloud)
{
  const std::size_t needed = header.points() * header.point_bytes;
  const std::size_t available = content.size() - header.body_begin;
  if (available < needed) {
    failAtByte(file, content.size(), "the file ends " + std::to_string(needed - available) + " bytes too early");
  }
  const auto* begin = reinterpret_cast<const std::uint8_t*>(content.data()) + header.body_begin;
  cloud.data.assign(begin, begin + needed);
}

/// Compressed files hold all values of the first field, then all of the second, and so on.
void interleave(const PcdHeader& header, const std::vector<char>& columns, pcl::PCLPointCloud2& cloud)
{
  cloud.data.assign(header.points() * header.point_bytes, 0);
  const char* source = columns.data();
  for (const PcdField& field : header.fields) {
    std::uint8_t* target = cloud.data.data() + field.offset;
    for (std::size_t i = 0; i < header.points(); ++i) {
      std::memcpy(target, source, field.bytes());
      source += field.bytes();
      target += header.point_bytes;
    }
  }
}

void readCompressed(const std::filesystem::path& file, const PcdHeader& header, std::string_view content,
                    pcl::PCLPointCloud2& cloud)
{
  const std::size_t needed = header.points() * header.point_bytes;
  std::uint32_t sizes[2] = {0, 0};  // compressed, uncompressed
  const std::size_t available = content.size() - header.body_begin;
  if (available < sizeof(sizes)) {
    failAtByte(file, content.size(), "the file ends before the sizes of the compressed data");
  }
  std::memcpy(sizes, content.data() + header.body_begin, sizeof(sizes));
  const std::size_t begin = header.body_begin + sizeof(sizes);
  if (sizes[0] > content.size() - begin) {
    failAtByte(file, content.size(),
               "the file ends " + std::to_string(sizes[0] - (content.size() - begin)) + " bytes too early");
  }
  if (sizes[1] != needed) {
    failAtByte(file, header.body_begin,
               "the compressed data are of " + std::to_string(sizes[1]) + " bytes, but the header asks for " +
                   std::to_string(needed));
  }
  // The format cannot pack more than this; without the check a few bytes could ask for gigabytes of memory.
  constexpr std::size_t kHighestRatio = 264;
  if (needed > kHighestRatio * sizes[0]) {
    failAtByte(file, header.body_begin,
               std::to_string(sizes[0]) + " compressed bytes cannot hold " + std::to_string(needed));
  }
  std::vector<char> columns(needed);
  if (needed > 0 && pcl::lzfDecompress(content.data() + begin, sizes[0], columns.data(), sizes[1]) != sizes[1]) {
    failAtByte(file, begin, "the compressed data are damaged");
  }
  interleave(header, columns, cloud);
}

template <typename Number>
bool storeNumber(std::string_view word, std::uint8_t* target)
{
  const auto number = parseNumber<Number>(word);
  if (number) {
    std::memcpy(target, &*number, sizeof(Number));
  }
  return number.has_value();
}

/// Floating point: PCL writes "nan"; numbers too small for the type are zero rather than an error.
template <typename Number>
bool storeFloat(std::string_view word, std::uint8_t* target)
{
  const auto number = parseNumber<double>(word);
  const Number value = static_cast<Number>(number.value_or(0.0));
  std::memcpy(target, &value, sizeof(Number));
  return number.has_value();
}

/// Integers: some programs write "7.0" or "1e+06"; what the type cannot hold exactly is refused.
template <typename Number>
bool storeInteger(std::string_view word, std::uint8_t* target)
{
  if (storeNumber<Number>(word, target)) {
    return true;
  }
  const auto number = parseNumber<double>(word);
  constexpr double kExact = 9007199254740992.0;  // 2^53
  if (!number || !(*number >= -kExact && *number <= kExact) ||
      *number < static_cast<double>(std::numeric_limits<Number>::lowest()) ||
      *number > static_cast<double>(std::numeric_limits<Number>::max())) {
    return false;
  }
  const auto value = static_cast<Number>(*number);
  std::memcpy(target, &value, sizeof(Number));
  return static_cast<double>(value) == *number;
}

bool storeElement(const PcdField& field, std::string_view word, std::uint8_t* target)
{
  const bool is_signed = field.type == 'I';
  if (field.type == 'F') {
    return field.size == 4 ? storeFloat<float>(word, target) : storeFloat<double>(word, target);
  }
  switch (field.size) {
    case 1: return is_signed ? storeInteger<std::int8_t>(word, target) : storeInteger<std::uint8_t>(word, target);
    case 2: return is_signed ? storeInteger<std::int16_t>(word, target) : storeInteger<std::uint16_t>(word, target);
    case 4: return is_signed ? storeInteger<std::int32_t>(word, target) : storeInteger<std::uint32_t>(word, target);
    default: return is_signed ? storeInteger<std::int64_t>(word, target) : storeInteger<std::uint64_t>(word, target);
  }
}

/// Stores one line's words as a point. \return empty, or what is wrong with the line
std::string storePoint(const PcdHeader& header, const std::vector<std::string_view>& words, std::uint8_t* point)
{
  std::size_t next = 0;
  for (const PcdField& field : header.fields) {
    for (std::uint32_t element = 0; element < field.count; ++element, ++next) {
      if (next >= words.size()) {
        return "only " + std::to_string(words.size()) + " numbers";
      }
      if (!storeElement(field, words[next], point + field.offset + static_cast<std::size_t>(element) * field.size)) {
        return "'" + std::string(words[next].substr(0, 40)) + "' is no value for field '" + field.name + "'";
      }
    }
  }
  return next == words.size() ? std::string()
                              : std::to_string(words.size()) + " numbers instead of " + std::to_string(next);
}

void readAscii(const std::filesystem::path& file, const PcdHeader& header, std::string_view content,
               pcl::PCLPointCloud2& cloud)
{
  std::string_view rest = content.substr(header.body_begin);
  // Every number takes two characters at least: a header that promises more asks for memory in vain.
  std::size_t numbers = 0;
  for (const PcdField& field : header.fields) {
    numbers += field.count;
  }
  constexpr std::size_t kLittle = 1U << 20U;  // bytes; of smaller clouds, the line that is too short is told
  if (header.points() * header.point_bytes > kLittle && 2 * numbers * header.points() > rest.size() + 1) {
    failAtByte(file, content.size(), "the file is too short for " + std::to_string(header.points()) + " points");
  }
  cloud.data.assign(header.points() * header.point_bytes, 0);
  std::size_t line_number = header.lines;
  for (std::size_t i = 0; i < header.points();) {
    if (rest.empty()) {
      throw FileError(file, "line " + std::to_string(line_number) + ": the file ends after " + std::to_string(i) +
                                " of " + std::to_string(header.points()) + " points");
    }
    const std::vector<std::string_view> words = splitWords(takeLine(rest));
    ++line_number;
    if (words.empty() || words.front().front() == '#') {
      continue;
    }
    const std::string problem = storePoint(header, words, cloud.data.data() + i * header.point_bytes);
    if (!problem.empty()) {
      throw FileError(file, "line " + std::to_string(line_number) + ": " + problem);
    }
    ++i;
  }
}

/// PCL's name of a field's type; 0 for 64-bit integers, which PCL 1.12 has none for.
std::uint8_t pclType(const PcdField& field)
{
  using pcl::PCLPointField;
  const bool is_signed = field.type == 'I';
  if (field.type == 'F') {
    return field.size == 4 ? PCLPointField::FLOAT32 : PCLPointField::FLOAT64;
  }
  switch (field.size) {
    case 1: return is_signed ? PCLPointField::INT8 : PCLPointField::UINT8;
    case 2: return is_signed ? PCLPointField::INT16 : PCLPointField::UINT16;
    case 4: return is_signed ? PCLPointField::INT32 : PCLPointField::UINT32;
    default: return 0;
  }
}

void describeCloud(const PcdHeader& header, pcl::PCLPointCloud2& cloud)
{
  cloud.fields.clear();
  for (const PcdField& field : header.fields) {
    const std::uint8_t type = pclType(field);
    if (type != 0 && !field.isPadding()) {
      pcl::PCLPointField description;
      description.name = field.name;
      description.offset = field.offset;
      description.datatype = type;
      description.count = field.count;
      cloud.fields.push_back(description);
    }
  }
  cloud.width = header.width;
  cloud.height = header.height;
  cloud.point_step = header.point_bytes;
  cloud.row_step = header.point_bytes * header.width;
  cloud.is_bigendian = 0;
  cloud.is_dense = 0;  // points that are not finite are let through
}

}  // namespace

void readPcdBody(const std::filesystem::path& file, const PcdHeader& header, std::string_view content,
                 pcl::PCLPointCloud2& cloud)
{
  describeCloud(header, cloud);
  switch (header.encoding) {
    case PcdEncoding::ascii: readAscii(file, header, content, cloud); break;
    case PcdEncoding::binary: readBinary(file, header, content, cloud); break;
    case PcdEncoding::binary_compressed: readCompressed(file, header, content, cloud); break;
  }
  makeCoordinatesFloat(cloud);
}

}  // namespace pcl_floam
