/// \file dataset_writer.h
/// Sweeps on disk, as odometry programs read them.
#pragma once

#include "simulation.h"

#include <filesystem>
#include <fstream>

namespace pcl_floam::simulator {

enum class DatasetFormat {
  pcd,    ///< scans/000000.pcd ...: binary, x y z intensity ring time, in firing order
  livox,  ///< the same with what Livox's driver writes: x y z intensity tag line timestamp (ns, float64)
  kitti   ///< velodyne/000000.bin ...: float32 x y z intensity, ring by ring as KITTI's files are
};

/// A folder of scans with times.txt (s, start of each sweep) and the sensor's exact poses at each sweep's start,
/// middle and end: poses_start.txt, poses_middle.txt, poses_end.txt, KITTI rows of `world_T_sensor`, all in the
/// world's frame.
class DatasetWriter {
public:
  /// Creates the folder.
  /// \throws std::runtime_error if it holds scans already or cannot be written
  DatasetWriter(const std::filesystem::path& folder, DatasetFormat format);

  /// Adds the next sweep.
  /// \throws std::runtime_error if it cannot be written
  void write(const Sweep& sweep);

private:
  std::filesystem::path scans_;
  DatasetFormat format_;
  std::ofstream times_, starts_, middles_, ends_;
};

/// Writes a sweep as KITTI does: rings from the top down, azimuth rising from 0 (front) to 2 pi within each, float32
/// x y z intensity with intensity from 0 to 1. Points without return are left out.
/// \throws std::runtime_error if it cannot be written
void writeKittiBin(const std::filesystem::path& file, const Sweep& sweep);

}  // namespace pcl_floam::simulator
