#include "replay.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam::viewer {

void Replay::advance(double seconds)
{
  if (!paused_ && size_ > 0) {
    position_ = std::min(position_ + rate_ * seconds, last());
  }
}

std::size_t Replay::current() const
{
  return static_cast<std::size_t>(std::min(position_, last()));
}

void Replay::stepTo(double position)
{
  paused_ = true;
  position_ = std::clamp(position, 0.0, last());
}

bool Replay::press(const std::string& key)
{
  const auto shown = static_cast<double>(current());
  if (key == "space") {
    paused_ = !paused_;
  } else if (key == "Right") {
    stepTo(shown + 1.0);
  } else if (key == "Left") {
    stepTo(shown - 1.0);
  } else if (key == "Home") {
    stepTo(0.0);
  } else if (key == "End") {
    stepTo(last());
  } else {
    return false;
  }
  return true;
}

}  // namespace pcl_floam::viewer
