/// \file replay.h
/// Which pose of a trajectory is shown: runs by itself, waits, or goes step by step.
#pragma once

#include <cstddef>
#include <string>

namespace pcl_floam::viewer {

class Replay {
public:
  /// \param rate poses per second
  /// \param first the pose to begin with; as far as there are so many
  Replay(double rate, std::size_t first) : rate_(rate), position_(static_cast<double>(first)) {}

  /// There are so many poses now; more may come while the odometry runs.
  void setSize(std::size_t size) { size_ = size; }

  /// Goes on by the time that has passed, unless paused; waits at the last pose for more.
  void advance(double seconds);

  /// Does what a key stands for, by its name in VTK. \return false if it stands for nothing here
  bool press(const std::string& key);

  /// The pose to show; meaningless without any.
  [[nodiscard]] std::size_t current() const;
  [[nodiscard]] bool isPaused() const { return paused_; }

private:
  [[nodiscard]] double last() const { return size_ > 0 ? static_cast<double>(size_ - 1) : 0.0; }
  void stepTo(double position);

  double rate_;
  double position_;
  std::size_t size_ = 0;
  bool paused_ = false;
};

}  // namespace pcl_floam::viewer
