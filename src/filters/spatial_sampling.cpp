#include "filters/spatial_sampling.h"

#include "common/hash.h"
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

/// As large as the last sample asked for; smaller tables stay in the cache.
void SpatialSampling::forget()
{
  constexpr std::size_t kFewest = 1024;
  constexpr unsigned kFewestShift = 64 - 10;
  std::size_t slots = kFewest;
  shift_ = kFewestShift;
  for (; slots < 3 * used_; slots *= 2) {
    --shift_;
  }
  table_.assign(slots, {});
  used_ = 0;
  last_ = 0;
}

void SpatialSampling::grow()
{
  smaller_.assign(2 * table_.size(), {});
  smaller_.swap(table_);
  --shift_;
  for (const Block& block : smaller_) {
    if (block.key != 0) {
      table_[placeOf(block.key)] = block;
    }
  }
}

/// Where a block is, or where it would come.
std::size_t SpatialSampling::placeOf(std::uint64_t key) const
{
  std::size_t i = hashOf(key, shift_);
  while (table_[i].key != 0 && table_[i].key != key) {
    i = (i + 1) & (table_.size() - 1);
  }
  return i;
}

bool SpatialSampling::isFirst(std::uint64_t cube)
{
  constexpr std::uint64_t kInBlock = kWithinBlock << (2 * kBits) | kWithinBlock << kBits | kWithinBlock;
  const std::uint64_t key = (cube & ~kInBlock) + 1;  // 0 is none
  if (table_[last_].key != key) {
    last_ = placeOf(key);
    if (table_[last_].key == 0) {
      table_[last_].key = key;
      if (2 * ++used_ > table_.size()) {
        grow();
        last_ = placeOf(key);
      }
    }
  }
  const std::uint64_t place = (cube >> (2 * kBits - 4) & kWithinBlock << 4U) |
                              (cube >> (kBits - 2) & kWithinBlock << 2U) | (cube & kWithinBlock);
  const std::uint64_t bit = std::uint64_t{1} << place;
  const bool is_first = (table_[last_].cubes & bit) == 0;
  table_[last_].cubes |= bit;
  return is_first;
}

/// Those of a batch that are the first ones in their cubes.
void SpatialSampling::addFirst(const ReturnBatch& batch, float inverse_side, std::vector<ScanPoint>& sample)
{
  std::array<std::uint64_t, ReturnBatch::kMost> cubes;
  findCubes(batch.count, batch.x.data(), batch.y.data(), batch.z.data(), inverse_side, cubes.data());
  std::uint64_t last = ~std::uint64_t{0};
  for (std::size_t n = 0; n < batch.count; ++n) {
    if (cubes[n] != last && isFirst(cubes[n])) {
      sample.push_back(batch.point(n));
    }
    last = cubes[n];
  }
}

void SpatialSampling::sample(const ScanReturns& returns, double side, std::vector<ScanPoint>& sample)
{
  sample.clear();
  forget();
  ReturnReader reader(returns);
  for (ReturnBatch batch; reader.next(batch);) {
    addFirst(batch, static_cast<float>(1.0 / side), sample);
  }
  setTimes(returns.cloud, returns.timing, sample);
}

void SpatialSampling::sample(const std::vector<ScanPoint>& points, double side, std::vector<ScanPoint>& sample)
{
  sample.clear();
  forget();
  std::array<float, ReturnBatch::kMost> x, y, z;
  std::array<std::uint64_t, ReturnBatch::kMost> cubes;
  for (std::size_t begin = 0; begin < points.size(); begin += ReturnBatch::kMost) {
    const std::size_t count = std::min(ReturnBatch::kMost, points.size() - begin);
    for (std::size_t n = 0; n < count; ++n) {
      x[n] = points[begin + n].x;
      y[n] = points[begin + n].y;
      z[n] = points[begin + n].z;
    }
    findCubes(count, x.data(), y.data(), z.data(), static_cast<float>(1.0 / side), cubes.data());
    for (std::size_t n = 0; n < count; ++n) {
      if (isFirst(cubes[n])) {
        sample.push_back(points[begin + n]);
      }
    }
  }
}

/// Whether places fill more than so many cubes.
bool SpatialSampling::fillMore(const Places& places, double side, std::size_t cells)
{
  forget();
  std::array<std::uint64_t, ReturnBatch::kMost> cubes;
  std::size_t filled = 0;
  for (std::size_t begin = 0; begin < places.x.size() && filled <= cells; begin += cubes.size()) {
    const std::size_t count = std::min(cubes.size(), places.x.size() - begin);
    findCubes(count, &places.x[begin], &places.y[begin], &places.z[begin], static_cast<float>(1.0 / side),
              cubes.data());
    for (std::size_t n = 0; n < count; ++n) {
      filled += isFirst(cubes[n]) ? 1 : 0;
    }
  }
  return filled > cells;
}

double SpatialSampling::sideFor(const ScanReturns& returns, double per_root)
{
  constexpr double kSmallest = 1e-3;  // m: finer than any lidar measures
  constexpr double kGreatest = 1e3;   // m: farther than any lidar sees
  constexpr int kHalvings = 16;       // to a part in 5,000
  Places places;
  ReturnReader reader(returns);
  for (ReturnBatch batch; reader.next(batch);) {
    const auto count = static_cast<std::ptrdiff_t>(batch.count);
    places.x.insert(places.x.end(), batch.x.begin(), batch.x.begin() + count);
    places.y.insert(places.y.end(), batch.y.begin(), batch.y.begin() + count);
    places.z.insert(places.z.end(), batch.z.begin(), batch.z.begin() + count);
  }
  if (places.x.empty()) {
    return 0.0;
  }
  const auto cells = static_cast<std::size_t>(per_root * std::sqrt(static_cast<double>(places.x.size())));
  double small = std::log(kSmallest);
  double great = std::log(kGreatest);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (small + great);
    (fillMore(places, std::exp(middle), cells) ? small : great) = middle;
  }
  return std::exp(great);
}

}  // namespace pcl_floam
