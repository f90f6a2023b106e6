#include "benchmark/stage_benchmarks.h"

#include "common/sweep_trajectory.h"
#include "filters/line_points.h"
#include "filters/smoothness.h"
#include "map/kdtree_search.h"
#include "registration/correspondences.h"
#include "registration/factors.h"
#include "registration/information_analysis.h"
#include "registration/normal_equations.h"

#include <pcl_floam/filters/core/sweep_motion.h>
#include <pcl_floam/registration/core/feature_registration.h>

#include <benchmark/benchmark.h>

#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>

#include <cmath>
#include <functional>
#include <memory>

namespace pcl_floam::benchmark {

namespace {

namespace gb = ::benchmark;

using SharedInput = std::shared_ptr<const StageInput>;

constexpr std::size_t kQueries = 1000;

/// Registers one benchmark that repeats \p work.
void add(const std::string& group, const std::string& stage, const std::function<void()>& work)
{
  gb::RegisterBenchmark((group + "/" + stage).c_str(), [work](gb::State& state) {
    for (auto _ : state) {
      work();
    }
  })->Unit(gb::kMillisecond);
}

/// The least that any odometry must do: read each point once, write one number for it.
void readEveryPoint(const StageInput& input, std::vector<float>& output)
{
  const CloudView view = viewOf(input.scan);
  output.resize(view.size);
  for (std::size_t i = 0; i < view.size; ++i) {
    output[i] = view.x(i) + view.y(i) + view.z(i);
  }
  gb::DoNotOptimize(output.data());
}

void smoothnessOfAllLines(const StageInput& input, LinePoints& line, std::vector<float>& sigma)
{
  for (std::size_t m = 0; m < input.lines.lines(); ++m) {
    line.gather(viewOf(input.scan), input.lines, m);
    computeSmoothness(line, LineNeighborhood().each_side, input.parameters.features.smoothness, sigma);
    gb::DoNotOptimize(sigma.data());
  }
}

std::vector<Eigen::Vector3d> planeQueries(const StageInput& input)
{
  std::vector<Eigen::Vector3d> queries;
  const auto& planes = input.features.planes;
  for (std::size_t i = 0; i < kQueries; ++i) {
    const Feature& f = planes[i * planes.size() / kQueries];
    queries.emplace_back(input.world_T_scan * Eigen::Vector3d(f.x, f.y, f.z));
  }
  return queries;
}

void search(const NeighborSearch& layer, const std::vector<Eigen::Vector3d>& queries, std::vector<Neighbors>& found)
{
  const RegistrationRun defaults;
  layer.nearestOfEach(queries.data(), queries.size(), kFitNeighbors, defaults.max_correspondence_distance,
                      found.data());
  gb::DoNotOptimize(found.data());
}

RegistrationRun runOf(const StageInput& input, int threads = 1)
{
  RegistrationRun run;
  run.guess = input.world_T_scan * exp(0.1 * input.twist);  // a prediction that is off by a tenth of the motion
  run.threads = threads;
  run.sweep.twist = input.twist;
  run.sweep.reference = 0.5;
  return run;
}

FeatureTarget targetOf(const KeyframeVoxelMap& map)
{
  return {&map.search(FeatureKind::edge), &map.search(FeatureKind::plane)};
}

void registerPointStages(const std::string& name, const SharedInput& input)
{
  add(name, "every point read once", [input, out = std::vector<float>()]() mutable { readEveryPoint(*input, out); });
  add(name, "scan lines", [input, lines = ScanLines()]() mutable {
    findScanLines(viewOf(input->scan), input->parameters.sensor, ScanLineSource::automatic, lines);
  });
  add(name, "times", [input] { gb::DoNotOptimize(findScanTiming(viewOf(input->scan), input->lines)); });
  add(name, "smoothness (Eq. 1)", [input, line = LinePoints(), sigma = std::vector<float>()]() mutable {
    smoothnessOfAllLines(*input, line, sigma);
  });
  add(name, "features, smoothness included", [input, features = FeatureSet()]() mutable {
    extractFeatures(viewOf(input->scan), input->lines, input->timing, input->parameters.features, features);
  });
  add(name, "compensation (Eq. 4)", [input, features = FeatureSet()]() mutable {
    compensate(input->features, SweepMotion(input->twist, 0.5), features);
  });
}

void registerMapStages(const std::string& name, const SharedInput& input)
{
  add(name, "map insertion", [input, map = input->map]() mutable { map.insert(input->features, input->world_T_scan); });
  const auto queries = planeQueries(*input);
  auto found = std::vector<Neighbors>(queries.size());
  add(name, "1000 searches, voxels",
      [input, queries, found]() mutable { search(input->map.search(FeatureKind::plane), queries, found); });
  const auto tree = std::make_shared<const KdTreeSearch>(input->map.points(FeatureKind::plane));
  add(name, "1000 searches, KD-tree", [tree, queries, found]() mutable { search(*tree, queries, found); });
  add(name, "KD-tree over the map's planes",
      [points = input->map.points(FeatureKind::plane)] { gb::DoNotOptimize(KdTreeSearch(points)); });
  search(input->map.search(FeatureKind::plane), queries, found);
  add(name, "1000 plane fits", [input, found] {
    for (const Neighbors& neighbors : found) {
      gb::DoNotOptimize(fitPlane(neighbors));
    }
  });
  add(name, "1000 line fits", [input, found] {
    for (const Neighbors& neighbors : found) {
      gb::DoNotOptimize(fitLine(neighbors));
    }
  });
}

void registerRegistrationStages(const std::string& name, const SharedInput& input)
{
  const auto target = std::make_shared<FeatureTarget>(targetOf(input->map));
  const auto problem = std::make_shared<RegistrationProblem>(
      RegistrationProblem{*target, input->parameters.registration, input->world_T_scan.translation, 1});
  auto links = std::make_shared<Correspondences>();
  const SweepTrajectory trajectory(SE3(input->world_T_scan.rotation, Eigen::Vector3d::Zero()), input->twist, 0.5);
  const std::vector<double> edge_weights(input->features.edges.size(), 1.0);
  const std::vector<double> plane_weights(input->features.planes.size(), 1.0);
  findCorrespondences(*problem, input->features, edge_weights, plane_weights, trajectory, 1.0, 1, *links);
  add(name, "one Gauss-Newton step, all features", [input, target, problem, links] {
    const NormalEquations equations = buildNormalEquations(*problem, *links, adaptKernelScales(*links));
    gb::DoNotOptimize(InformationAnalysis(equations).step());
  });
  add(name, "registration", [input, target] {
    gb::DoNotOptimize(registerFeatures(input->features, *target, runOf(*input), input->parameters.registration));
  });
}

void registerPclParts(const std::string& name, const SharedInput& input)
{
  auto filtered = pcl::make_shared<CloudXYZI>();
  pcl::VoxelGrid<XYZI> grid;
  grid.setLeafSize(0.5F, 0.5F, 0.5F);
  grid.setInputCloud(input->cloud);
  grid.filter(*filtered);
  add(name, "PCL: VoxelGrid, 0.5 m", [input, grid]() mutable {
    CloudXYZI output;
    grid.filter(output);
  });
  add(name, "PCL: KdTreeFLANN of the result", [filtered] {
    pcl::KdTreeFLANN<XYZI> tree;
    tree.setInputCloud(filtered);
  });
  add(name, "PCL: the reference, both", [input] { gb::DoNotOptimize(runReference(input->cloud)); });
}

}  // namespace

std::size_t runReference(const CloudXYZI::ConstPtr& cloud)
{
  pcl::VoxelGrid<XYZI> grid;
  grid.setLeafSize(0.5F, 0.5F, 0.5F);
  grid.setInputCloud(cloud);
  const auto filtered = pcl::make_shared<CloudXYZI>();
  grid.filter(*filtered);
  pcl::KdTreeFLANN<XYZI> tree;
  tree.setInputCloud(filtered);
  return filtered->size();
}

void registerStages(const ScanSequence& sequence)
{
  const auto input = std::make_shared<const StageInput>(sequence);
  const std::string name = "stage/" + sequence.name;
  registerPclParts(name, input);
  registerPointStages(name, input);
  registerMapStages(name, input);
  registerRegistrationStages(name, input);
}

void registerGrowth(const ScanSequence& sequence)
{
  const auto input = std::make_shared<const StageInput>(sequence);
  const auto target = std::make_shared<FeatureTarget>(targetOf(input->map));
  for (const std::size_t every : {8U, 4U, 2U, 1U}) {  // whole scan lines are left out
    auto lines = std::make_shared<ScanLines>();
    lines->begin.push_back(0);
    for (std::size_t m = 0; m < input->lines.lines(); m += every) {
      lines->index.insert(lines->index.end(), input->lines.index.begin() + input->lines.begin[m],
                          input->lines.index.begin() + input->lines.begin[m + 1]);
      lines->begin.push_back(static_cast<std::int32_t>(lines->index.size()));
    }
    add("growth/features by points", std::to_string(lines->index.size()), [input, lines, out = FeatureSet()]() mutable {
      extractFeatures(viewOf(input->scan), *lines, input->timing, input->parameters.features, out);
    });
  }
  for (const std::size_t part : {4U, 2U, 1U}) {
    const auto features = std::make_shared<FeatureSet>(input->features);
    features->edges.resize(features->edges.size() / part);
    features->planes.resize(features->planes.size() / part);
    add("growth/registration by features", std::to_string(features->edges.size() + features->planes.size()),
        [input, target, features] {
          gb::DoNotOptimize(registerFeatures(*features, *target, runOf(*input), input->parameters.registration));
        });
  }
  for (const std::size_t scans : {10U, 30U, 100U}) {
    const auto from = sequence.scans.end() - static_cast<std::ptrdiff_t>(std::min(scans, sequence.scans.size()));
    const ScanSequence last{sequence.name, sequence.parameters, {from, sequence.scans.end()}};
    const auto part = std::make_shared<const StageInput>(last);
    const auto part_target = std::make_shared<FeatureTarget>(targetOf(part->map));
    const std::size_t size = part->map.size(FeatureKind::edge) + part->map.size(FeatureKind::plane);
    add("growth/registration by map points", std::to_string(size), [part, part_target] {
      gb::DoNotOptimize(registerFeatures(part->features, *part_target, runOf(*part), part->parameters.registration));
    });
  }
}

}  // namespace pcl_floam::benchmark
