// pcl_floam_convert: from a recording to a folder of PCD files.

#include "command_line.h"
#include "interruption.h"
#include "progress_bar.h"
#include "result_writer.h"
#include "scan_saver.h"

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/scan_writer.h>

#include <iostream>
#include <system_error>

using namespace pcl_floam;
using namespace pcl_floam::tools;

namespace {

constexpr const char* kDescription =
    "Writes the scans of a recording (mcap, rosbag 1 and 2, pcap of Velodyne packets) or of a folder as\n"
    "PCD files with all fields, and times.txt with the time of each.";

constexpr const char* kFooter =
    "\nExit status: 0 all scans written; 1 a scan could not be read (the recording is cut off or damaged) or\n"
    "written: those that could are there; 2 bad option or input; 130, 143 interrupted.\n"
    "\nExamples:\n"
    "  pcl_floam_convert drive.mcap --output scans\n"
    "  pcl_floam_convert rosbag2_2024_05_01/ --topic /lidar/points --output scans\n"
    "  pcl_floam_convert hdl64.pcap --calibration db.xml --output scans\n"
    "  pcl_floam_convert drive.mcap --list\n";

struct ConvertOptions {
  std::filesystem::path scans;
  std::filesystem::path output;
  std::string topic;
  std::filesystem::path calibration;  ///< of an HDL-64; empty: none
  bool list = false;
  bool quiet = false;
};

void addConvertOptions(CLI::App& app, ConvertOptions& o)
{
  app.add_option("SCANS", o.scans, "recording, or folder of scans")->required()->type_name("PATH");
  auto* output =
      app.add_option("-o,--output", o.output, "folder for the scans; created if need be")->type_name("FOLDER");
  app.add_option("--topic", o.topic, "topic of the scans, where there are several")->type_name("NAME");
  app.add_option("--calibration", o.calibration,
                 "of a Velodyne HDL-64, to decode its packets: its db.xml,\nor the YAML made of it")
      ->type_name("FILE");
  app.add_flag("--list", o.list, "only list the topics")->excludes(output);
  app.add_flag("-q,--quiet", o.quiet, "no progress; problems are still told");
  app.set_help_flag("-h,--help", "this help");
  app.set_version_flag("--version", PCL_FLOAM_VERSION);
  app.footer(kFooter);
}

int list(const ConvertOptions& options)
{
  for (const ScanTopic& topic : listTopics(options.scans)) {
    std::cout << topic.name << "  " << topic.type << "  " << topic.messages << " messages"
              << (topic.has_scans ? "" : "  (no scans that are read)") << '\n';
  }
  return kExitFine;
}

/// Writes scan after scan.
class Converter {
public:
  Converter(const ScanSource& scans, const ConvertOptions& options)
      : scans_(scans), options_(options), progress_(scans.size(), options.quiet)
  {
  }

  /// \return whether all could be read and written
  bool run()
  {
    bool complete = true;
    try {
      for (std::size_t i = 0; i < scans_.size() && interruptedBy() == 0; ++i) {
        complete &= convert(i);
        progress_.update(i + 1);
      }
      finish();
    } catch (const FileError& error) {  // a full disk: the next would not fit either
      progress_.message(error.what());
      complete = false;
      finish();
    }
    return complete;
  }

private:
  bool convert(std::size_t i)
  {
    std::optional<double> stamp;
    try {
      scans_.read(i, cloud_);
      stamp = scans_.stamp(i);
    } catch (const std::exception& error) {
      progress_.message(error.what());
      return false;
    }
    try {
      writePcd(cloud_, options_.output / numberedName(i));
    } catch (const std::invalid_argument& error) {
      progress_.message(scans_.name(i) + ": " + error.what());
      return false;
    }
    has_times_ &= stamp.has_value();
    times_.push_back(stamp.value_or(0.0));
    return true;
  }

  void finish()
  {
    if (has_times_ && !times_.empty()) {
      writeTimes(times_, options_.output / "times.txt");
    }
  }

  const ScanSource& scans_;
  const ConvertOptions& options_;
  ProgressBar progress_;
  pcl::PCLPointCloud2 cloud_;
  std::vector<double> times_;
  bool has_times_ = true;
};

int run(const ConvertOptions& options)
{
  const ScanSource scans(options.scans, ScanSourceOptions{options.topic, options.calibration});
  prepareScanFolder(options.output);
  noteInterruptions();
  const bool complete = Converter(scans, options).run();
  constexpr int kSignalBase = 128;  // as shells have it
  return interruptedBy() != 0 ? kSignalBase + interruptedBy() : (complete ? kExitFine : kExitIncomplete);
}

}  // namespace

int main(int argc, char** argv)
{
  ConvertOptions options;
  CLI::App app(kDescription, "pcl_floam_convert");
  useReadableHelp(app);
  addConvertOptions(app, options);
  if (const auto status = parseCommandLine(app, argc, argv)) {
    return *status;
  }
  if (options.output.empty() && !options.list) {
    return reportUsageError(app, "--output is required");
  }
  try {
    return options.list ? list(options) : run(options);
  } catch (const std::exception& error) {
    return reportUsageError(app, error.what());
  }
}
