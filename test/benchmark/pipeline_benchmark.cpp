#include "benchmark/stage_benchmarks.h"

#include <benchmark/benchmark.h>

#include <pcl/conversions.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>

namespace pcl_floam::benchmark {

namespace {

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

void runPipeline(const ScanSequence& sequence, int threads, ::benchmark::State& state)
{
  OdometryParameters parameters = sequence.parameters;
  parameters.threads = threads;
  std::vector<double> odometry_times;
  std::vector<double> reference_times;
  for (auto _ : state) {
    OdometryPipeline odometry(parameters);
    for (const pcl::PCLPointCloud2& scan : sequence.scans) {
      const auto cloud = pcl::make_shared<CloudXYZI>();
      pcl::fromPCLPointCloud2(scan, *cloud);
      reference_times.push_back(milliseconds(threads == 1, [&] { runReference(cloud); }));
      odometry_times.push_back(milliseconds(threads == 1, [&] { odometry.track(viewOf(scan)); }));
    }
  }
  const double reference = quantile(reference_times, 0.5);
  state.counters["median_ms"] = quantile(odometry_times, 0.5);
  state.counters["p95_ms"] = quantile(odometry_times, 0.95);
  state.counters["reference_ms"] = reference;
  state.counters["ratio"] = quantile(odometry_times, 0.5) / reference;
  state.counters["p95_ratio"] = quantile(odometry_times, 0.95) / reference;
}

}  // namespace

void registerPipeline(const ScanSequence& sequence, int threads)
{
  const std::string name = "pipeline/" + sequence.name + "/" + std::to_string(threads) + " threads";
  ::benchmark::RegisterBenchmark(
      name.c_str(), [sequence, threads](::benchmark::State& state) { runPipeline(sequence, threads, state); })
      ->Unit(::benchmark::kMillisecond)
      ->Iterations(1);
}

}  // namespace pcl_floam::benchmark
