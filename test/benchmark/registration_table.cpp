// Ours against PCL's registrations on pairs with known transforms: one run prints the README's table.
//
//   registration_table [--methods ours,GICP] [--data FOLDER] [kind ...]
#include "benchmark/registration_methods.h"
#include "benchmark/registration_pairs.h"

#include <pcl/console/print.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace pcl_floam::benchmark {
namespace {

/// What a method did on the pairs of one kind.
struct Score {
  std::vector<double> errors;   ///< m, from near guesses
  std::vector<double> seconds;  ///< from near guesses
  int successes = 0;            ///< over the grid
  int attempts = 0;
};

struct Offset {
  double degrees;
  double shift;  ///< in extents of the cloud
};

const std::vector<Offset> kNear = {{3.0, 0.02}, {5.0, 0.05}};
const std::vector<Offset> kGrid = {{10.0, 0.1}, {20.0, 0.1}, {30.0, 0.1}, {45.0, 0.1},
                                   {60.0, 0.1}, {10.0, 0.3}, {10.0, 0.6}, {30.0, 0.3}};
const std::vector<Eigen::Vector3d> kAxes = {{0.0, 0.0, 1.0}, {0.6, -0.64, 0.48}};

/// The truth, turned about the source's centroid and shifted.
SE3 guessFor(const CloudPair& pair, const Offset& offset, const Eigen::Vector3d& axis)
{
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Point& point : *pair.source) {
    centroid += point.getVector3fMap().cast<double>();
  }
  centroid = pair.target_T_source * (centroid / static_cast<double>(pair.source->size()));
  const Eigen::Matrix3d turn = expSO3(offset.degrees * 3.14159265358979323846 / 180.0 * axis);
  // Most of the shift is level: scans are not taken from below the ground.
  const Eigen::Vector3d shift = offset.shift * pair.extent * Eigen::Vector3d(0.74, -0.66, 0.12).normalized();
  return SE3(turn, centroid + shift - turn * centroid) * pair.target_T_source;
}

double median(std::vector<double> values)
{
  if (values.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double errorOf(const MethodResult& result, const CloudPair& pair)
{
  const double error = disagreement(*pair.source, result.target_T_source, pair.target_T_source);
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

Score scoreOf(const std::string& method, const PairKind& kind)
{
  Score score;
  for (const CloudPair& pair : kind.pairs) {
    for (const Offset& offset : kNear) {
      const MethodResult result = runMethod(method, pair, guessFor(pair, offset, kAxes[1]));
      score.errors.push_back(errorOf(result, pair));
      score.seconds.push_back(result.seconds);
    }
  }
  for (const CloudPair& pair : kind.grid_pairs) {
    for (const Offset& offset : kGrid) {
      for (const Eigen::Vector3d& axis : kAxes) {
        const MethodResult result = runMethod(method, pair, guessFor(pair, offset, axis));
        score.successes += errorOf(result, pair) <= pair.success ? 1 : 0;
        ++score.attempts;
      }
    }
  }
  return score;
}

void printRow(const PairKind& kind, const std::vector<std::string>& methods)
{
  std::printf("| %s, %zu points |", kind.name.c_str(), kind.pairs.front().source->size());
  for (const std::string& method : methods) {
    const Score score = scoreOf(method, kind);
    std::printf(" %.3g mm, %.0f ms", 1e3 * median(score.errors), 1e3 * median(score.seconds));
    if (score.attempts > 0) {
      std::printf(", %d/%d", score.successes, score.attempts);
    }
    std::printf(" |");
    std::fflush(stdout);
  }
  std::printf("\n");
}

int run(int argc, char** argv)
{
  std::vector<std::string> methods = methodNames();
  std::vector<std::string> kinds;
  std::string data = PCL_FLOAM_DEFAULT_DATA;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--methods" && i + 1 < argc) {
      methods.clear();
      std::istringstream list(argv[++i]);
      for (std::string name; std::getline(list, name, ',');) {
        methods.push_back(name);
      }
    } else if (argument == "--data" && i + 1 < argc) {
      data = argv[++i];
    } else {
      kinds.push_back(argument);
    }
  }
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  std::printf("Median error and time from near guesses; successes over the grid of initial offsets.\n\n| pairs |");
  for (const std::string& method : methods) {
    std::printf(" %s |", method.c_str());
  }
  std::printf("\n|---|");
  for (std::size_t i = 0; i < methods.size(); ++i) {
    std::printf("---|");
  }
  std::printf("\n");
  for (const PairKind& kind : makePairs(data, kinds)) {
    printRow(kind, methods);
  }
  return 0;
}

}  // namespace
}  // namespace pcl_floam::benchmark

int main(int argc, char** argv)
{
  return pcl_floam::benchmark::run(argc, argv);
}
