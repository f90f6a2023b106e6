#include "io/recordings/rosbag2_folder.h"

#include "io/natural_order.h"
#include "io/text.h"
#include "io/whole_file.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace pcl_floam {

namespace fs = std::filesystem;

namespace {

bool endsWith(std::string_view text, std::string_view ending)
{
  return text.size() >= ending.size() && text.substr(text.size() - ending.size()) == ending;
}

bool isRecording(const fs::path& file)
{
  const std::string name = file.filename().string();
  return endsWith(name, ".mcap") || endsWith(name, ".db3") || endsWith(name, ".mcap.zstd") ||
         endsWith(name, ".db3.zstd");
}

/// Of ROS 1; not what reindexing left of one.
bool isBag(const fs::directory_entry& entry)
{
  const std::string name = entry.path().filename().string();
  std::error_code error;
  return endsWith(name, ".bag") && !endsWith(name, ".orig.bag") && entry.is_regular_file(error);
}

std::string_view withoutQuotes(std::string_view word)
{
  const bool quoted = word.size() > 1 && (word.front() == '"' || word.front() == '\'') && word.back() == word.front();
  return quoted ? word.substr(1, word.size() - 2) : word;
}

/// The items of `relative_file_paths`. That list is in every version; names may have spaces, or their folder before
/// them, which may have another name by now.
std::vector<std::string> namedFiles(const fs::path& metadata)
{
  const std::string content = readWholeFile(metadata);
  std::string_view rest = content;
  std::vector<std::string> names;
  bool inside = false;
  while (!rest.empty()) {
    const std::string_view line = takeLine(rest);
    const std::size_t begin = line.find_first_not_of(" \t");
    const std::size_t end = line.find_last_not_of(" \t\r");
    if (begin == std::string_view::npos) {
      continue;
    }
    const std::string_view words = line.substr(begin, end + 1 - begin);
    if (inside && words.substr(0, 2) == "- ") {
      names.push_back(fs::path(withoutQuotes(words.substr(words.find_first_not_of("- ")))).filename().string());
    } else {
      inside = words == "relative_file_paths:";
    }
  }
  return names;
}

/// A compressed file may be named without its .zstd, or have been unpacked since.
fs::path present(const fs::path& file)
{
  constexpr std::string_view kPacked = ".zstd";
  const std::string name = file.string();
  const std::string other =
      endsWith(name, kPacked) ? name.substr(0, name.size() - kPacked.size()) : name + std::string(kPacked);
  std::error_code error;
  return !fs::exists(file, error) && fs::exists(other, error) ? fs::path(other) : file;
}

}  // namespace

std::vector<fs::path> rosbag2Files(const fs::path& folder)
{
  std::vector<fs::path> files;
  std::error_code error;
  if (fs::exists(folder / "metadata.yaml", error)) {
    for (const std::string& name : namedFiles(folder / "metadata.yaml")) {
      files.push_back(present(folder / name));
    }
  }
  if (!files.empty()) {
    return files;
  }
  std::vector<fs::path> bags;
  bool has_scans = false;
  for (fs::directory_iterator entries(folder, error), end; !error && entries != end; entries.increment(error)) {
    if (isRecording(entries->path())) {
      files.push_back(entries->path());
    } else if (isBag(*entries)) {
      bags.push_back(entries->path());
    }
    has_scans |= entries->path().extension() == ".pcd" || entries->path().extension() == ".bin";
  }
  if (files.empty() && !has_scans) {  // else scans that were taken out of a bag lie beside it
    files = std::move(bags);
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return naturallyBefore(a.filename().string(), b.filename().string());
  });
  return files;
}

}  // namespace pcl_floam
