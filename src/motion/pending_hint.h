/// \file pending_hint.h
/// What was told of the motion since the last scan that was registered.
#pragma once

#include <pcl_floam/motion/motion_hint.h>

#include <optional>

namespace pcl_floam {

class PendingHint {
public:
  /// Of the motion to the scan that comes next.
  void give(const MotionHint& hint) { next_ = hint; }

  /// That scan comes. \param goes_on whether scans since the last one that was registered told nothing
  void elapse(bool goes_on)
  {
    if (!goes_on) {
      since_ = next_;
    } else {
      since_ = since_ && next_ ? std::optional<MotionHint>(*since_ * *next_) : std::nullopt;
    }
    next_.reset();
  }

  [[nodiscard]] const std::optional<MotionHint>& sinceLast() const { return since_; }

private:
  std::optional<MotionHint> next_;
  std::optional<MotionHint> since_;
};

}  // namespace pcl_floam
