/// \file pcl_registrations.h
/// PCL's own registrations, set up for scan-to-scan odometry as a user of PCL would.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace pcl_floam::experiments {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

struct RegistrationSettings {
  int iterations = 50;
  double max_distance = 1.0;  ///< m, between corresponding points; not for NDT
  double resolution = 1.0;    ///< m, NDT's cells
};

/// Registers each scan to the one before it.
class ScanMatcher {
public:
  virtual ~ScanMatcher() = default;

  /// The first scan, or the first after one that failed.
  virtual void start(const Cloud::Ptr& scan) = 0;

  /// Registers a scan to the last one, and keeps it as the last one.
  /// \param guess last_T_scan
  /// \param result last_T_scan
  /// \return whether it converged
  virtual bool match(const Cloud::Ptr& scan, const Eigen::Matrix4f& guess, Eigen::Matrix4f& result) = 0;
};

/// icp, icp-plane, gicp or ndt.
/// \throws std::invalid_argument for another name
[[nodiscard]] std::unique_ptr<ScanMatcher> makeScanMatcher(const std::string& method,
                                                           const RegistrationSettings& settings);

/// The names that \ref makeScanMatcher knows.
[[nodiscard]] const std::vector<std::string>& scanMatcherNames();

}  // namespace pcl_floam::experiments
