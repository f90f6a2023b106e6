// The odometry over many scans with faults thrown in: nothing grows, and what goes wrong is told.
//
// A few hundred scans in the default run; PCL_FLOAM_SOAK_SCANS says how many else (ctest -C Soak -L soak).
#include "support/synthetic_cloud.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#if defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define PCL_FLOAM_HAS_MALLINFO2
#endif
#endif

namespace pcl_floam::test {
namespace {

using Cloud = pcl::PointCloud<PointXYZIRT>;

constexpr int kLap = 100;  // scans
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Round and round on a circle of 2 m, in a room that has been seen after one lap.
SE3 pathAt(double scan)
{
  const double angle = 2.0 * kPi * scan / kLap;
  return {expSO3(Eigen::Vector3d(0.0, 0.0, angle)),
          Eigen::Vector3d(2.0 * std::sin(angle), -2.0 * std::cos(angle) - 1.0, 0.05 * std::sin(3.0 * angle))};
}

std::vector<Cloud> sweepsOfOneLap()
{
  Lidar lidar;
  lidar.rings = 16;
  lidar.columns = 720;  // any fewer, and walls count as seen at grazing incidence
  std::vector<Cloud> sweeps;
  for (int k = 0; k < kLap; ++k) {
    sweeps.push_back(toCloud(sweepRoom(Room(), lidar, [k](double fraction) { return pathAt(k - 1.0 + fraction); })));
  }
  return sweeps;
}

enum class Fault {
  none,
  missing_returns,  ///< a random part of the points at (0,0,0) or not finite
  blind,            ///< all of them
  garbage,          ///< points anywhere, absurdly far ones among them
  empty,
  unreadable,    ///< the caller says that the scan is missing
  repeated,      ///< the scan before once more, with its time
  dropped,       ///< up to five scans never come, and nobody says so
  out_of_order,  ///< the next scan comes first
  time_jump,     ///< the clock is set, forwards or back
  time_unknown,  ///< a time that is not finite, or none
  time_stands,   ///< hardly later than the scan before
  count
};

/// One thing that is delivered to the odometry.
struct Delivery {
  int scan = 0;  ///< its number along the path
  Fault fault = Fault::none;
  std::optional<double> stamp;
};

/// Scans in their order with faults in one of ten, from a seed.
class FaultyLidar {
public:
  explicit FaultyLidar(unsigned seed) : random_(seed), sweeps_(sweepsOfOneLap()) {}

  Delivery next()
  {
    Delivery delivery;
    if (late_ >= 0) {
      delivery.scan = std::exchange(late_, -1);
      delivery.fault = Fault::out_of_order;
      delivery.stamp = stampOf(delivery.scan);
      return delivery;
    }
    delivery.fault = chooseFault();
    delivery.scan = advance(delivery.fault);
    delivery.stamp = stampOf(delivery.scan);
    if (delivery.fault == Fault::time_unknown) {
      delivery.stamp = random_() % 2 == 0 ? std::optional<double>() : std::numeric_limits<double>::infinity();
    } else if (delivery.fault == Fault::time_stands) {
      *delivery.stamp += 1e-7 - 0.1;
    }
    return delivery;
  }

  Cloud cloud(const Delivery& delivery)
  {
    Cloud cloud = sweeps_[static_cast<std::size_t>(delivery.scan % kLap)];
    const double part = delivery.fault == Fault::missing_returns ? 0.6 * chance_(random_) : 1.0;
    switch (delivery.fault) {
      case Fault::missing_returns:
      case Fault::blind:
      case Fault::garbage: spoil(cloud, delivery.fault, part); break;
      case Fault::empty: cloud.clear(); break;
      default: break;
    }
    return cloud;
  }

private:
  Fault chooseFault()
  {
    constexpr int kClean = 30;  // scans to start with
    const bool faulty = scan_ > kClean && random_() % 10 == 0;
    return faulty ? static_cast<Fault>(1 + random_() % (static_cast<unsigned>(Fault::count) - 1)) : Fault::none;
  }

  /// \return the number of the scan to deliver
  int advance(Fault fault)
  {
    switch (fault) {
      case Fault::repeated: return scan_;
      case Fault::dropped: return scan_ += 2 + static_cast<int>(random_() % 5);
      case Fault::out_of_order: late_ = scan_ + 1; return scan_ += 2;
      case Fault::time_jump: clock_ += 1e4 * (chance_(random_) - 0.5); return ++scan_;
      default: return ++scan_;
    }
  }

  [[nodiscard]] double stampOf(int scan) const { return clock_ + 0.1 * scan; }

  void spoil(Cloud& cloud, Fault fault, double part)
  {
    const bool not_finite = random_() % 2 == 0;
    std::uniform_real_distribution<float> anywhere(-60.0F, 60.0F);
    for (PointXYZIRT& point : cloud) {
      if (fault == Fault::garbage) {
        point.getVector3fMap() = Eigen::Vector3f(anywhere(random_), anywhere(random_), anywhere(random_));
        point.x = random_() % 20 == 0 ? 1e30F : point.x;
      } else if (chance_(random_) <= part) {
        point.getVector3fMap().setConstant(not_finite ? kNaN : 0.0F);
      }
    }
  }

  std::mt19937 random_;
  std::uniform_real_distribution<double> chance_;
  std::vector<Cloud> sweeps_;
  int scan_ = -1;
  int late_ = -1;  ///< a scan that was overtaken
  double clock_ = 1317013366.0;
};

/// What the run was like.
struct Record {
  std::vector<double> milliseconds;
  std::size_t tracked = 0;
  double worst_error = 0.0;  ///< m, of a scan said to be tracked
  std::size_t bytes_after_a_quarter = 0;
};

/// Nothing where the C library does not tell, as under a sanitizer.
std::size_t bytesInUse()
{
#ifdef PCL_FLOAM_HAS_MALLINFO2
  return mallinfo2().uordblks + mallinfo2().hblkhd;
#else
  return 0;
#endif
}

std::size_t scansToRun()
{
  const char* given = std::getenv("PCL_FLOAM_SOAK_SCANS");
  return given == nullptr ? 200 : std::strtoul(given, nullptr, 10);
}

void checkReport(const OdometryReport& report, const Delivery& delivery, Record& record)
{
  ASSERT_TRUE(report.world_T_sensor.isFinite()) << "scan " << delivery.scan;
  if (report.state == TrackingState::tracked) {
    const SE3 truth = pathAt(0.0).inverse() * pathAt(delivery.scan);
    const double error = (report.world_T_sensor.translation - truth.translation).norm();
    record.worst_error = std::max(record.worst_error, error);
    ++record.tracked;
    ASSERT_LT(error, 0.3) << "unreported failure in scan " << delivery.scan << ", fault "
                          << static_cast<int>(delivery.fault);
  } else {
    ASSERT_TRUE(report.state == TrackingState::initialized || !report.reason.empty()) << "scan " << delivery.scan;
    ASSERT_NE(report.state, TrackingState::not_started);
  }
  if (delivery.scan > 1) {  // the second scan looks for the first motion, which takes its time
    record.milliseconds.push_back(report.milliseconds.total);
  }
}

TEST(Soak, FaultsAreToldAndNothingGrows)
{
  const std::size_t scans = scansToRun();
  FaultyLidar lidar(3);
  OdometryPipeline odometry;
  Record record;
  for (std::size_t i = 0; i < scans; ++i) {
    const Delivery delivery = lidar.next();
    const Cloud cloud = lidar.cloud(delivery);
    const OdometryReport& report = delivery.fault == Fault::unreadable ? odometry.trackMissing(delivery.stamp)
                                                                       : odometry.track(viewOf(cloud), delivery.stamp);
    ASSERT_NO_FATAL_FAILURE(checkReport(report, delivery, record));
    if (i == scans / 4) {
      record.bytes_after_a_quarter = bytesInUse();
    }
  }
  std::sort(record.milliseconds.begin(), record.milliseconds.end());
  const double median = record.milliseconds[record.milliseconds.size() / 2];
  std::cout << scans << " scans, " << record.tracked << " tracked, worst error " << record.worst_error << " m, median "
            << median << " ms, slowest " << record.milliseconds.back() << " ms, " << record.bytes_after_a_quarter
            << " bytes after a quarter, " << bytesInUse() << " at the end\n";
  EXPECT_GT(record.tracked, scans * 9 / 10);
  if (scans >= 10000) {  // a short run may meet anything on a busy machine
    EXPECT_LT(record.milliseconds.back(), 10.0 * median);
  }
  EXPECT_LE(bytesInUse(), record.bytes_after_a_quarter * 5 / 4);
}

}  // namespace
}  // namespace pcl_floam::test
