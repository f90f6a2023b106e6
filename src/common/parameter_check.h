/// \file parameter_check.h
/// Settings out of range become std::invalid_argument with one clear sentence.
#pragma once

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace pcl_floam {

/// Checks the settings of one component. Every check also refuses NaN.
class ParameterCheck {
public:
  explicit ParameterCheck(std::string component) : component_(std::move(component)) {}

  void range(const char* name, double value, double lowest, double highest) const
  {
    require(value >= lowest && value <= highest, name, value, "between", lowest, " and ", highest);
  }
  void atLeast(const char* name, double value, double lowest) const
  {
    require(value >= lowest && std::isfinite(value), name, value, "at least", lowest);
  }
  void above(const char* name, double value, double limit) const
  {
    require(value > limit && std::isfinite(value), name, value, "greater than", limit);
  }

private:
  template <typename... Bound>
  void require(bool valid, const char* name, double value, const char* relation, Bound... bound) const
  {
    if (!valid) {
      std::ostringstream message;
      message << component_ << ": " << name << " is " << value << " but must be " << relation << ' ';
      (message << ... << bound);
      throw std::invalid_argument(message.str());
    }
  }

  std::string component_;
};

}  // namespace pcl_floam
