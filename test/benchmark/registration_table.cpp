// Ours against PCL's registrations on pairs with known transforms: one run prints the README's table.
//
//   registration_table [--quick] [--seed N] [--methods ours,GICP] [--data FOLDER] [kind ...]
//
// Below the table it lists where ours does not keep what it promises. Times are the processor's.
#include "benchmark/registration_methods.h"
#include "benchmark/registration_pairs.h"
#include "support/constants.h"

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

using pcl_floam::test::kPi;

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
  const Eigen::Matrix3d turn = expSO3(offset.degrees * kPi / 180.0 * axis);
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

/// A row of the table: the scores by method.
using Row = std::map<std::string, Score>;

Row printRow(const PairKind& kind, const std::vector<std::string>& methods)
{
  Row row;
  std::printf("| %s, %zu points |", kind.name.c_str(), kind.pairs.front().source->size());
  for (const std::string& method : methods) {
    const Score score = scoreOf(method, kind);
    std::printf(" %.3g mm, %.0f ms", 1e3 * median(score.errors), 1e3 * median(score.seconds));
    if (score.attempts > 0) {
      std::printf(", %d/%d", score.successes, score.attempts);
    }
    std::printf(" |");
    std::fflush(stdout);
    row[method] = score;
  }
  std::printf("\n");
  return row;
}

/// What ours promises, as far as the row tells: successes as of the best, an error as of the better of point-to-plane
/// ICP and GICP, from 5,000 points on less time than ICP and than a third of GICP's.
void printShortfalls(const PairKind& kind, const Row& row)
{
  const std::vector<std::string>& names = methodNames();
  const auto ours = row.find(names[0]);
  for (const auto& [method, score] : row) {
    if (ours == row.end() || method == names[0]) {
      continue;
    }
    const bool accurate = method == names[2] || method == names[3];
    const bool large = kind.pairs.front().source->size() >= 4900;  // a little room, for scans have no round number
    const double share = method == names[3] ? 1.0 / 3.0 : 1.0;
    if (ours->second.successes < score.successes) {
      std::printf("%s: fewer successes than %s\n", kind.name.c_str(), method.c_str());
    }
    if (accurate && median(ours->second.errors) > median(score.errors)) {
      std::printf("%s: less accurate than %s\n", kind.name.c_str(), method.c_str());
    }
    if (large && (method == names[1] || method == names[3]) &&
        median(ours->second.seconds) > share * median(score.seconds)) {
      std::printf("%s: slower than %s of %s's time\n", kind.name.c_str(), share < 1.0 ? "a third" : "all",
                  method.c_str());
    }
  }
}

struct Options {
  std::vector<std::string> methods = methodNames();
  PairSelection pairs;
};

Options readOptions(int argc, char** argv)
{
  Options options;
  options.pairs.data = PCL_FLOAM_DEFAULT_DATA;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--methods" && i + 1 < argc) {
      options.methods.clear();
      std::istringstream list(argv[++i]);
      for (std::string name; std::getline(list, name, ',');) {
        options.methods.push_back(name);
      }
    } else if (argument == "--data" && i + 1 < argc) {
      options.pairs.data = argv[++i];
    } else if (argument == "--seed" && i + 1 < argc) {
      options.pairs.seed = static_cast<unsigned>(std::stoul(argv[++i]));
    } else if (argument == "--quick") {
      options.pairs.quick = true;
    } else {
      options.pairs.kinds.push_back(argument);
    }
  }
  return options;
}

int run(int argc, char** argv)
{
  const Options options = readOptions(argc, argv);
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  std::printf("Median error and time from near guesses; successes over the grid of initial offsets.\n\n| pairs |");
  for (const std::string& method : options.methods) {
    std::printf(" %s |", method.c_str());
  }
  std::printf("\n|---|");
  for (std::size_t i = 0; i < options.methods.size(); ++i) {
    std::printf("---|");
  }
  std::printf("\n");
  const std::vector<PairKind> kinds = makePairs(options.pairs);
  std::vector<Row> rows;
  for (const PairKind& kind : kinds) {
    rows.push_back(printRow(kind, options.methods));
  }
  std::printf("\n");
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    printShortfalls(kinds[i], rows[i]);
  }
  return 0;
}

}  // namespace
}  // namespace pcl_floam::benchmark

int main(int argc, char** argv)
{
  return pcl_floam::benchmark::run(argc, argv);
}
