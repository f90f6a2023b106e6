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

  /// That scan comes.
  void elapse()
  {
    if (place_ == Place::is_given) {
      since_.reset();
    } else if (place_ == Place::is_known) {
      since_ = next_;
    } else {
      since_ = since_ && next_ ? std::optional<MotionHint>(*since_ * *next_) : std::nullopt;
    }
    next_.reset();
    place_ = Place::is_sought;
  }

  /// The last scan was registered.
  void reach() { place_ = Place::is_known; }

  /// The pose of the scan that comes next was given: what was told of the way there counts no more.
  void placeNext() { place_ = Place::is_given; }

  [[nodiscard]] const std::optional<MotionHint>& sinceLast() const { return since_; }

private:
  enum class Place { is_known, is_sought, is_given };

  Place place_ = Place::is_known;
  std::optional<MotionHint> next_;
  std::optional<MotionHint> since_;
};

}  // namespace pcl_floam
