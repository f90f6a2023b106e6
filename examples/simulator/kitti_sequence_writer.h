/// \file kitti_sequence_writer.h
/// Sweeps as a sequence of KITTI's odometry benchmark.
#pragma once

#include "simulation.h"

#include <filesystem>
#include <fstream>
#include <string>

namespace pcl_floam::simulator {

/// Every point where it would have been measured from the sweep's middle: what KITTI's benchmark calls untwisted.
[[nodiscard]] Sweep compensatedAtMiddle(const Simulation& simulation, const Sweep& sweep);

/// A tree laid out as KITTI's archives are: sequences/NN/velodyne/000000.bin, sequences/NN/calib.txt and times.txt, and
/// poses/NN.txt with the *camera's* poses, of which the first is the identity. The scans are compensated.
class KittiSequenceWriter {
public:
  /// Creates the folders; other sequences may be there already.
  /// \throws std::runtime_error if the sequence holds scans already or cannot be written
  KittiSequenceWriter(const std::filesystem::path& root, const std::string& sequence);

  /// Adds the next sweep of a simulation.
  /// \throws std::runtime_error if it cannot be written
  void write(const Simulation& simulation, const Sweep& sweep);

private:
  std::filesystem::path scans_;
  std::ofstream times_, poses_;
  SE3 first_T_world_;
  bool begun_ = false;
};

}  // namespace pcl_floam::simulator
