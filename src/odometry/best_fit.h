/// \file best_fit.h
/// Which of several guesses explains a scan.
#pragma once

#include <pcl_floam/registration/registration_report.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace pcl_floam {

/// Of registrations of the same features from several guesses that link about as many of these as any does, the one
/// with the least residuals; the first, the likeliest guess, if it is one of them, unless it is clearly worse.
/// \param clearly_better residuals of the first that another one must stay below, as a part of them
/// \return its place; 0 if none has converged
inline std::size_t bestFit(const std::vector<RegistrationReport>& tried, double clearly_better)
{
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kCorrespondences = 0.8;  // of the most, at least
  const auto linked = [](const RegistrationReport& report) {
    return report.hasConverged() ? report.edge_correspondences + report.plane_correspondences : 0;
  };
  int most = 0;
  for (const RegistrationReport& report : tried) {
    most = std::max(most, linked(report));
  }
  std::size_t best = 0;
  double residual = kInfinity;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    if (most > 0 && linked(tried[i]) >= kCorrespondences * most && tried[i].residual_rms < residual) {
      best = i;
      residual = (i == 0 ? clearly_better : 1.0) * tried[i].residual_rms;
    }
  }
  return best;
}

}  // namespace pcl_floam
