/// \file scene.h
/// The picture: map, trajectory, scan and its features, seen by PCL's viewer.
#pragma once

#include "odometry_result.h"

#include <pcl_floam/common/se3.h>

#include <pcl/visualization/pcl_visualizer.h>

#include <functional>
#include <string>

namespace pcl_floam::viewer {

/// A scan in its sensor's frame.
struct SeenScan {
  Cloud::Ptr points = pcl::make_shared<Cloud>();
  Cloud::Ptr edges = pcl::make_shared<Cloud>();
  Cloud::Ptr planes = pcl::make_shared<Cloud>();
};

class Scene {
public:
  /// Opens a window, or none. \param keys is told the name of every key that is pressed
  Scene(bool off_screen, std::function<void(const std::string&)> keys);

  /// Map grey, its edges darker orange; of the path so far a line.
  void showMap(const OdometryResult& result);
  void showPath(const Trajectory& poses, std::size_t current);
  /// Points white, planes blue, edges red.
  void showScan(const SeenScan& scan, const SE3& world_T_sensor);
  void showText(const std::string& text);

  /// From behind and above, as a kite sees it.
  void follow(const SE3& world_T_sensor);
  /// All of the path and what surrounds it, from above at a slant.
  void overlook(const Trajectory& poses);

  /// Draws, and takes what the user does. \return false once the window is closed, or if there is none
  bool draw();
  /// Writes what was drawn last as a PNG file; PCL's own way would need a window.
  void save(const std::string& picture);

private:
  struct Look {
    double r, g, b;  ///< 0 to 255
    double size;     ///< pixels
  };
  void show(const Cloud::ConstPtr& cloud, const Look& look, const std::string& name);

  bool off_screen_;
  pcl::visualization::PCLVisualizer viewer_;
};

}  // namespace pcl_floam::viewer
