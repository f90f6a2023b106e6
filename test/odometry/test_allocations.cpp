// What the odometry asks of the heap once it runs: nothing where its map no longer grows.
//
// This program's own malloc counts; new ends there, too.
#include "common/multi_version.h"
#include "support/synthetic_cloud.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#if defined(__GLIBC__) && !defined(PCL_FLOAM_SANITIZED)
#define PCL_FLOAM_COUNTS_ALLOCATIONS

namespace {

std::atomic<bool> is_counting{false};
std::atomic<std::size_t> allocations{0};

void noteAllocation()
{
  if (is_counting) {
    ++allocations;
  }
}

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);                           // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void* memory, std::size_t size);            // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT(bugprone-reserved-identifier)

void* malloc(std::size_t size)
{
  noteAllocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size)
{
  noteAllocation();
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size)
{
  noteAllocation();
  return __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size)
{
  noteAllocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size)
{
  noteAllocation();
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}
}
#endif

namespace pcl_floam::test {
namespace {

using Cloud = pcl::PointCloud<PointXYZIRT>;

constexpr int kLap = 40;  // scans

struct Spinning {
  const char* name;
  Lidar lidar;
};

std::ostream& operator<<(std::ostream& out, const Spinning& sensor)
{
  return out << sensor.name;
}

/// Round and round on a circle of a metre, in a room.
SE3 pathAt(double scan)
{
  const double angle = 2.0 * kPi * scan / kLap;
  return {expSO3(Eigen::Vector3d(0.0, 0.0, angle)), Eigen::Vector3d(std::sin(angle), -std::cos(angle), 0.0)};
}

class Allocations : public testing::TestWithParam<Spinning> {
protected:
  void SetUp() override
  {
#if !defined(PCL_FLOAM_COUNTS_ALLOCATIONS)
    GTEST_SKIP() << "allocations are counted with glibc, without a sanitizer's own malloc";
#endif
    for (int k = 0; k < kLap; ++k) {
      sweeps_.push_back(
          toCloud(sweepRoom(Room(), GetParam().lidar, [k](double part) { return pathAt(k - 1.0 + part); })));
    }
  }

  /// Of each scan of one lap.
  std::vector<std::size_t> allocationsOfALap(OdometryPipeline& odometry)
  {
    std::vector<std::size_t> counts(sweeps_.size(), 0);
#if defined(PCL_FLOAM_COUNTS_ALLOCATIONS)
    for (std::size_t i = 0; i < sweeps_.size(); ++i) {
      const CloudView scan = viewOf(sweeps_[i]);
      allocations = 0;
      is_counting = true;
      const OdometryReport& report = odometry.track(scan, 0.1 * static_cast<double>(scans_));
      is_counting = false;
      counts[i] = allocations;
      ++scans_;
      EXPECT_TRUE(scans_ < kFirst || report.state == TrackingState::tracked) << report.reason;
    }
#endif
    return counts;
  }

  static constexpr std::size_t kFirst = 15;  // scans until it is settled how the sensor began to move
  std::vector<Cloud> sweeps_;
  std::size_t scans_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Sensors, Allocations,
                         testing::Values(Spinning{"vlp16", {16, 1800, -15.0, 15.0}},
                                         Spinning{"hdl64", {64, 1000, -24.8, 2.0}}),
                         [](const auto& sensor) { return std::string(sensor.param.name); });

TEST_P(Allocations, NoneWhereTheMapNoLongerGrows)
{
  constexpr int kLapsUntilTheMapIsFull = 8;
  OdometryPipeline odometry{OdometryParameters()};
  for (int lap = 0; lap < kLapsUntilTheMapIsFull; ++lap) {
    allocationsOfALap(odometry);
  }
  const std::vector<std::size_t> counts = allocationsOfALap(odometry);
  EXPECT_EQ(std::count(counts.begin(), counts.end(), 0U), static_cast<std::ptrdiff_t>(counts.size()))
      << "most: " << *std::max_element(counts.begin(), counts.end());
}

/// What grows takes room for many of its kind at a time.
TEST_P(Allocations, FewWhereTheMapGrows)
{
  constexpr std::size_t kMostOfOneScan = 60;
  OdometryPipeline odometry{OdometryParameters()};
  std::vector<std::size_t> counts = allocationsOfALap(odometry);
  counts.erase(counts.begin(), counts.begin() + kFirst);
  EXPECT_LT(*std::max_element(counts.begin(), counts.end()), kMostOfOneScan);
  std::nth_element(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2), counts.end());
  EXPECT_EQ(counts[counts.size() / 2], 0U) << "of half the scans";
}

}  // namespace
}  // namespace pcl_floam::test
