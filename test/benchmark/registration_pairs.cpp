#include "benchmark/registration_pairs.h"

#include "benchmark/scan_pairs.h"
#include "support/constants.h"
#include "support/random_motion.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace pcl_floam::benchmark {

namespace {

using pcl_floam::test::kPi;

using pcl_floam::test::randomTwist;
using pcl_floam::test::uniform;

double normal(std::mt19937& random)
{
  double sum = 0.0;  // of twelve uniform numbers, for the same values with every standard library
  for (int i = 0; i < 12; ++i) {
    sum += uniform(random, 0.5);
  }
  return sum;
}

Eigen::Vector3d onSphere(std::mt19937& random)
{
  const double z = uniform(random, 1.0);
  const double angle = uniform(random, kPi);
  return {std::sqrt(1.0 - z * z) * std::cos(angle), std::sqrt(1.0 - z * z) * std::sin(angle), z};
}

/// A point of the table scene; the shapes have shares of the points that are about those of their areas.
Eigen::Vector3d onTable(std::mt19937& random, unsigned scene)
{
  const double turn = 0.7 * scene;
  const double u = uniform(random, 1.0);
  const double v = uniform(random, 1.0);
  const double which = 0.5 + uniform(random, 0.5);
  if (which < 0.55) {
    return {0.75 * u, 0.5 * v, 0.0};
  }
  if (which < 0.75) {  // three sides of a box
    const double side = uniform(random, 1.0);
    Eigen::Vector3d p(0.12 * u, 0.08 * v, 0.3);
    if (side < -0.3) {
      p = {0.12, 0.08 * u, 0.15 + 0.15 * v};
    } else if (side < 0.3) {
      p = {0.12 * u, -0.08, 0.15 + 0.15 * v};
    }
    return Eigen::Vector3d(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * p + Eigen::Vector3d(0.3, 0.1, 0.0));
  }
  if (which < 0.85) {
    return Eigen::Vector3d(0.12 * onSphere(random) + Eigen::Vector3d(-0.3, 0.2 * std::sin(turn), 0.12));
  }
  if (which < 0.94) {
    return {-0.1 + 0.06 * std::cos(kPi * u), -0.25 + 0.06 * std::sin(kPi * u), 0.1 + 0.1 * v};
  }
  return {0.1 + 0.1 * u, 0.3 + 0.1 * v, 0.1 + 0.05 * std::sin(3.0 * u + scene)};
}

/// A point of a body with bumps, at about even density.
Eigen::Vector3d onBody(std::mt19937& random, unsigned scene)
{
  const Eigen::Vector3d n = onSphere(random);
  const double radius = 0.1 * (1.0 + 0.25 * std::sin(3.0 * n.x() + scene) * std::cos(2.0 * n.y()) +
                               0.2 * std::sin(4.0 * n.z() + 2.0 * n.x()));
  return {radius * n.x(), 0.8 * radius * n.y(), 1.3 * radius * n.z()};
}

template <typename Surface>
Cloud::Ptr sample(const SceneSampling& sampling, const Surface& surface)
{
  std::mt19937 random(1000 * sampling.scene + sampling.seed);
  auto cloud = pcl::make_shared<Cloud>();
  for (int i = 0; i < sampling.points; ++i) {
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    const Eigen::Vector3d exact = surface(random, sampling.scene);
    const Eigen::Vector3d place = sampling.scale * (exact + sampling.noise * noise);
    Point point;
    point.getVector3fMap() = place.cast<float>();
    cloud->push_back(point);
  }
  return cloud;
}

void move(Cloud& cloud, const SE3& motion)
{
  for (Point& point : cloud) {
    point.getVector3fMap() = (motion * point.getVector3fMap().cast<double>()).cast<float>();
  }
}

/// Moves the source away by a random motion, so that nothing is aligned by chance.
CloudPair makePair(Cloud::Ptr source, Cloud::Ptr target, unsigned seed, double success_share)
{
  std::mt19937 random(seed);
  CloudPair pair;
  pair.extent = extentOf(*source);
  pair.target_T_source = exp(randomTwist(random, pair.extent, 0.8));
  move(*source, pair.target_T_source.inverse());
  pair.source = std::move(source);
  pair.target = std::move(target);
  pair.ndt_resolution = 0.2 * pair.extent;
  pair.success = success_share * pair.extent;
  return pair;
}

/// Every other point, at random.
std::pair<Cloud::Ptr, Cloud::Ptr> halves(const Cloud& cloud, unsigned seed)
{
  std::mt19937 random(seed);
  std::pair<Cloud::Ptr, Cloud::Ptr> halves{pcl::make_shared<Cloud>(), pcl::make_shared<Cloud>()};
  for (const Point& point : cloud) {
    (uniform(random, 1.0) < 0.0 ? *halves.first : *halves.second).push_back(point);
  }
  return halves;
}

CloudPair tablePair(unsigned scene, int points)
{
  return makePair(sampleTable({scene, 1, points, 0.001}), sampleTable({scene, 2, points, 0.001}), scene, 0.02);
}

CloudPair objectPair(unsigned scene, int points)
{
  return makePair(sampleObject({scene, 1, points, 0.0002}), sampleObject({scene, 2, points, 0.0002}), scene, 0.02);
}

CloudPair halvesPair(unsigned scene, int points)
{
  auto [source, target] = halves(*sampleTable({scene, 3, points}), scene);
  return makePair(std::move(source), std::move(target), scene, 0.02);
}

/// Points that both clouds have, up to noise, and some that only one has.
CloudPair keyPointPair(unsigned scene, int points)
{
  const auto common = sampleTable({scene, 4, points});
  auto source = sampleTable({scene, 5, points / 5});
  auto target = sampleTable({scene, 6, points / 5});
  std::mt19937 random(scene);
  for (const auto& cloud : {source, target}) {
    for (Point point : *common) {
      point.getVector3fMap() += 0.003F * Eigen::Vector3d(normal(random), normal(random), normal(random)).cast<float>();
      cloud->push_back(point);
    }
  }
  return makePair(std::move(source), std::move(target), scene, 0.05);
}

template <typename MakePair>
PairKind makeKind(const MakePair& make, unsigned seed, int points, int grid_points)
{
  const unsigned first = 10 * seed + 1;
  PairKind kind;
  for (unsigned scene = first; scene < first + 3; ++scene) {
    kind.pairs.push_back(make(scene, points));
  }
  kind.grid_pairs.push_back(make(first + 3, grid_points));
  return kind;
}

/// One pair of so many points, for the time only.
PairKind makeSize(unsigned seed, int points)
{
  PairKind kind;
  kind.pairs.push_back(tablePair(10 * seed + 5, points));
  return kind;
}

}  // namespace

Cloud::Ptr sampleTable(const SceneSampling& sampling)
{
  return sample(sampling, onTable);
}

Cloud::Ptr sampleObject(const SceneSampling& sampling)
{
  return sample(sampling, onBody);
}

double extentOf(const Cloud& cloud)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (const Point& point : cloud) {
    mean += point.getVector3fMap().cast<double>();
    squares += point.getVector3fMap().cast<double>().squaredNorm();
  }
  const auto count = static_cast<double>(cloud.size());
  return std::sqrt(squares / count - (mean / count).squaredNorm());
}

double disagreement(const Cloud& cloud, const SE3& a, const SE3& b)
{
  double sum = 0.0;
  for (const Point& point : cloud) {
    const Eigen::Vector3d p = point.getVector3fMap().cast<double>();
    sum += (a * p - b * p).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(cloud.size()));
}

std::vector<PairKind> makePairs(const PairSelection& selection)
{
  const std::vector<std::string>& wanted = selection.kinds;
  const unsigned seed = selection.seed;
  std::vector<PairKind> kinds;
  const auto add = [&](const std::string& name, const auto& make) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) {
      return;
    }
    PairKind kind = make();
    kind.name = name;
    if (selection.quick) {
      kind.pairs.resize(std::min<std::size_t>(1, kind.pairs.size()));
      kind.grid_pairs.clear();
    }
    if (!kind.pairs.empty()) {
      kinds.push_back(std::move(kind));
    }
  };
  add("indoor-scans", [&] { return simulatedScans("room", "vlp16", seed); });
  add("outdoor-scans", [&] { return simulatedScans("urban", "hdl32", seed); });
  add("real-scans", [&] { return realScans(selection.data, 4); });
  add("table", [&] { return makeKind(tablePair, seed, 29000, 6000); });
  add("object", [&] { return makeKind(objectPair, seed, 20000, 6000); });
  add("key-points", [&] { return makeKind(keyPointPair, seed, 300, 300); });
  add("halves", [&] { return makeKind(halvesPair, seed, 40000, 12000); });
  add("small-scans", [&] { return realScans(selection.data, 24); });
  add("table-5000", [&] { return makeSize(seed, 5000); });
  if (!selection.quick) {
    add("table-100000", [&] { return makeSize(seed, 100000); });
  }
  return kinds;
}

}  // namespace pcl_floam::benchmark
