#include "registration/start_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace pcl_floam {

namespace {

constexpr std::size_t kSample = 1000;

/// A number that depends on the point's place alone, so that the sample does not depend on the points' order.
std::uint64_t hashOf(const Eigen::Vector3f& point)
{
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &point[axis], sizeof(bits));
    hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29U;
  }
  return hash;
}

}  // namespace

StartChoice::StartChoice(const CloudLevel& source, const CloudLevel& target, double max_distance, int threads)
    : target_(target.tree),
      spacing_(std::max(source.spacing, target.spacing)),
      max_distance_(max_distance),
      threads_(threads)
{
  const std::size_t every = std::max<std::size_t>(1, source.tree.size() / kSample);
  for (const Eigen::Vector3f& point : source.tree.points()) {
    if (hashOf(point) % every == 0) {
      sample_.push_back(point);
    }
  }
}

std::vector<float> StartChoice::distances(const SE3& pose) const
{
  std::vector<float> distances(sample_.size());
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(sample_.size()); ++n) {
    const auto i = static_cast<std::size_t>(n);
    float squared = std::numeric_limits<float>::max();
    const int nearest = target_.nearest((pose * sample_[i].cast<double>()).cast<float>(), squared);
    distances[i] = nearest < 0 ? std::numeric_limits<float>::max() : std::sqrt(squared);
  }
  return distances;
}

bool StartChoice::isClose(const SE3& pose) const
{
  std::vector<float> sorted = distances(pose);
  if (sorted.empty()) {
    return true;
  }
  const auto most = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 3 / 4);
  std::nth_element(sorted.begin(), most, sorted.end());
  return static_cast<double>(*most) <= spacing_;
}

double StartChoice::cost(const SE3& pose) const
{
  const double scale = std::max(3.0 * spacing_, std::numeric_limits<double>::min());
  double sum = 0.0;
  for (const float distance : distances(pose)) {
    const auto d = static_cast<double>(distance);
    sum += d > max_distance_ ? 1.0 : d / (d + scale);
  }
  return sum / std::max(1.0, static_cast<double>(sample_.size()));
}

const SE3& StartChoice::better(const SE3& a, const SE3& b) const
{
  return cost(a) <= cost(b) ? a : b;
}

}  // namespace pcl_floam
