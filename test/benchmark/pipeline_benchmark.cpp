#include "benchmark/stage_benchmarks.h"

#include <benchmark/benchmark.h>

#include <pcl/conversions.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_floam::benchmark {

namespace {

constexpr int kRepeats = 3;  // of a sequence: what the reference varies between them is the machine's

/// Milliseconds that \p work takes: of this thread's processor time, or by the clock on the wall.
double milliseconds(bool processor_time, const std::function<void()>& work)
{
  const auto now = [processor_time] {
    if (processor_time) {
      timespec time{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
      return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
    }
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  const double begin = now();
  work();
  return now() - begin;
}

double quantile(std::vector<double> values, double part)
{
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1) + 0.5)];
}

/// Where a scan's time went for the most part.
std::string longestStage(const StageTimes& times)
{
  const std::array<std::pair<double, const char*>, 4> stages = {{{times.scan_lines, "scan lines"},
                                                                 {times.features, "features"},
                                                                 {times.registration, "registration"},
                                                                 {times.map, "map"}}};
  return std::max_element(stages.begin(), stages.end())->second;
}

struct Slowest {
  double milliseconds = 0.0;
  std::string label;  // which scan, counted from 0, and its longest stage
};

/// How much a thing varies that should be the same each time, of its middle.
double spread(const std::vector<double>& repeats)
{
  const auto [least, most] = std::minmax_element(repeats.begin(), repeats.end());
  return (*most - *least) / quantile(repeats, 0.5);
}

void runPipeline(const ScanSequence& sequence, int threads, ::benchmark::State& state)
{
  OdometryParameters parameters = sequence.parameters;
  parameters.threads = threads;
  std::vector<double> odometry_times;
  std::vector<double> reference_medians;
  Slowest slowest;
  for (auto _ : state) {
    OdometryPipeline odometry(parameters);
    std::vector<double> reference_times;
    for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
      const auto cloud = pcl::make_shared<CloudXYZI>();
      pcl::fromPCLPointCloud2(sequence.scans[i], *cloud);
      reference_times.push_back(milliseconds(threads == 1, [&] { runReference(cloud); }));
      odometry_times.push_back(milliseconds(threads == 1, [&] { odometry.track(viewOf(sequence.scans[i])); }));
      if (odometry_times.back() > slowest.milliseconds) {
        slowest = {odometry_times.back(),
                   "scan " + std::to_string(i) + ", " + longestStage(odometry.report().milliseconds)};
      }
    }
    reference_medians.push_back(quantile(reference_times, 0.5));
  }
  const double median = quantile(odometry_times, 0.5);
  const double reference = quantile(reference_medians, 0.5);
  state.SetLabel(slowest.label);
  state.counters["median_ms"] = median;
  state.counters["reference_ms"] = reference;
  state.counters["reference_spread"] = spread(reference_medians);
  state.counters["ratio"] = median / reference;
  state.counters["p95_medians"] = quantile(odometry_times, 0.95) / median;
  state.counters["p99_medians"] = quantile(odometry_times, 0.99) / median;
  state.counters["p999_medians"] = quantile(odometry_times, 0.999) / median;
  state.counters["slowest_medians"] = slowest.milliseconds / median;
}

}  // namespace

void registerPipeline(const ScanSequence& sequence, int threads)
{
  const std::string name = "pipeline/" + sequence.name + "/" + std::to_string(threads) + " threads";
  ::benchmark::RegisterBenchmark(
      name.c_str(), [sequence, threads](::benchmark::State& state) { runPipeline(sequence, threads, state); })
      ->Unit(::benchmark::kMillisecond)
      ->Iterations(kRepeats);
}

}  // namespace pcl_floam::benchmark
