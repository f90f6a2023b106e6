// Times the odometry, its stages, and the parts of PCL that a user would otherwise call, in one run.
#include "benchmark/stage_benchmarks.h"

#include <benchmark/benchmark.h>

#include <cstdlib>

int main(int argc, char** argv)
{
  using namespace pcl_floam::benchmark;
  const char* data = std::getenv("PCL_FLOAM_DATA");
  constexpr std::size_t kScans = 100;
  const ScanSequence sequences[] = {
      realDrive(data != nullptr ? data : PCL_FLOAM_DEFAULT_DATA), simulatedSequence("urban", "hdl64", kScans),
      simulatedSequence("warehouse", "vlp16", kScans), simulatedSequence("urban", "os128", kScans)};
  const ScanSequence* first = nullptr;
  for (const ScanSequence& sequence : sequences) {
    if (sequence.scans.empty()) {
      benchmark::AddCustomContext("left out", sequence.name);
      continue;
    }
    first = first == nullptr ? &sequence : first;
    registerPipeline(sequence, 1);
    registerPipeline(sequence, 2);
    registerStages(sequence);
  }
  if (first != nullptr) {
    registerGrowth(*first);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
