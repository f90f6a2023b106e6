#include "filters/spatial_sampling.h"

#include "common/multi_version.h"
#include "filters/point_times.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Cubes are kept in blocks of 4 x 4 x 4, each a bit: neighbours in a scan line are mostly of the same block.
constexpr std::uint64_t kWithinBlock = 3;
constexpr unsigned kBits = 21;  // of a coordinate

/// The cubes of some points: 21 bits of each coordinate.
PCL_FLOAM_MULTI_VERSION
void findCubes(std::size_t count, const float* x, const float* y, const float* z, float inverse_side,
               std::uint64_t* cubes)
{
  constexpr double kOffset = 1 << 20;  // makes all coordinates positive, of which the integer part is the floor
  const auto coordinate = [inverse_side](float v) {
    constexpr double kMost = 2e9;  // what integers hold
    constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
    const double place = static_cast<double>(v * inverse_side) + kOffset;
    const auto whole = static_cast<std::int32_t>(std::min(std::max(place, -kMost), kMost));
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(whole)) & kMask;
  };
  for (std::size_t n = 0; n < count; ++n) {
    cubes[n] = coordinate(x[n]) << (2 * kBits) | coordinate(y[n]) << kBits | coordinate(z[n]);
  }
}

}  // namespace

/// Calls \p take(number) for each point that is the first one in its cube; so many points at the most as a batch has.
template <typename Take>
void SpatialSampling::takeFirst(std::size_t count, const float* x, const float* y, const float* z, double side,
                                const Take& take)
{
  constexpr std::uint64_t kInBlock = kWithinBlock << (2 * kBits) | kWithinBlock << kBits | kWithinBlock;
  std::array<std::uint64_t, ReturnBatch::kMost> cubes;
  findCubes(count, x, y, z, static_cast<float>(1.0 / side), cubes.data());
  std::uint64_t last = 0;
  std::uint64_t* seen = nullptr;  // of the last block
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint64_t block = (cubes[n] & ~kInBlock) + 1;  // 0 is none
    seen = seen != nullptr && block == last ? seen : &seen_[block];
    last = block;
    const std::uint64_t place = (cubes[n] >> (2 * kBits - 4) & kWithinBlock << 4U) |
                                (cubes[n] >> (kBits - 2) & kWithinBlock << 2U) | (cubes[n] & kWithinBlock);
    const std::uint64_t bit = std::uint64_t{1} << place;
    if ((*seen & bit) == 0) {
      *seen |= bit;
      take(n);
    }
  }
}

void SpatialSampling::sample(const ScanReturns& returns, double side, std::vector<ScanPoint>& sample,
                             std::size_t enough)
{
  sample.clear();
  seen_.clear();
  ReturnReader reader(returns);
  for (ReturnBatch batch; sample.size() < enough && reader.next(batch);) {
    takeFirst(batch.count, batch.x.data(), batch.y.data(), batch.z.data(), side,
              [&](std::size_t n) { sample.push_back(batch.point(n)); });
  }
  setTimes(returns.cloud, returns.timing, sample);
}

void SpatialSampling::sample(const std::vector<ScanPoint>& points, double side, std::vector<ScanPoint>& sample)
{
  sample.clear();
  seen_.clear();
  std::array<float, ReturnBatch::kMost> x, y, z;
  for (std::size_t begin = 0; begin < points.size(); begin += ReturnBatch::kMost) {
    const std::size_t count = std::min(ReturnBatch::kMost, points.size() - begin);
    for (std::size_t n = 0; n < count; ++n) {
      x[n] = points[begin + n].x;
      y[n] = points[begin + n].y;
      z[n] = points[begin + n].z;
    }
    takeFirst(count, x.data(), y.data(), z.data(), side, [&](std::size_t n) { sample.push_back(points[begin + n]); });
  }
}

double SpatialSampling::sideFor(const ScanReturns& returns, double per_root)
{
  constexpr double kSmallest = 1e-3;  // m: finer than any lidar measures
  constexpr double kGreatest = 1e3;   // m: farther than any lidar sees
  constexpr int kHalvings = 16;       // to a part in 5,000
  std::size_t count = 0;
  ReturnReader reader(returns);
  for (ReturnBatch batch; reader.next(batch);) {
    count += batch.count;
  }
  if (count == 0) {
    return 0.0;
  }
  const auto cells = static_cast<std::size_t>(per_root * std::sqrt(static_cast<double>(count)));
  double small = std::log(kSmallest);
  double great = std::log(kGreatest);
  std::vector<ScanPoint> firsts;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (small + great);
    sample(returns, std::exp(middle), firsts, cells + 1);
    (firsts.size() > cells ? small : great) = middle;
  }
  return std::exp(great);
}

}  // namespace pcl_floam
