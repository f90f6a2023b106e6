#include "filters/line_rating.h"

#include "common/median.h"
#include "common/multi_version.h"
#include "filters/selectability.h"
#include "filters/smoothness.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// The paper's "5 points along the clockwise and counterclockwise".
constexpr int kNeighborsEachSide = 5;
/// An edge needs a smoothness of so many times the median of its scan line, which is two thirds of the range noise on
/// smooth surfaces: without it noise of 5 cm makes edges everywhere.
constexpr float kNoiseRatio = 5.0F;

/// Sorts a line's points into those sharp enough for edges and those smooth enough for planes.
PCL_FLOAM_MULTI_VERSION
void sortByUse(std::size_t count, const float* sigma, const std::int32_t* unfit, float edge_threshold,
               float plane_threshold, float* sharpness, float* flatness)
{
  for (std::size_t n = 0; n < count; ++n) {
    const bool fit = unfit[n] == 0;
    sharpness[n] = fit && sigma[n] > edge_threshold ? sigma[n] : 0.0F;
    flatness[n] = fit && sigma[n] < plane_threshold ? sigma[n] : kNeverFlat;
  }
}

}  // namespace

bool LineRating::rate(const CloudView& cloud, const ScanLines& lines, std::size_t m,
                      const FeatureParameters& parameters, const std::vector<std::uint8_t>& selectable)
{
  points.gather(cloud, lines, m);
  const LineNeighborhood neighborhood = neighborhoodIn(points, kNeighborsEachSide, sample_);
  each_side = neighborhood.each_side;
  if (points.size() <= 2 * each_side) {
    return false;
  }
  if (neighborhood.is_sparse && parameters.smoothness == SmoothnessKind::vector_sum) {
    computeSmoothnessAcross(points, each_side, sigma);
  } else {
    computeSmoothness(points, each_side, parameters.smoothness, sigma);
  }
  markUnfit(points, parameters, neighborhood, unfit_);
  edge_threshold = noiseThreshold(parameters);  // by all points of the line, asked for or not
  for (std::size_t n = 0; !selectable.empty() && n < unfit_.size(); ++n) {
    if (selectable[static_cast<std::size_t>(lines.index[static_cast<std::size_t>(lines.begin[m]) + n])] == 0) {
      unfit_[n] = 1;
    }
  }
  sharpness.resize(sigma.size());
  flatness.resize(sigma.size());
  sortByUse(sigma.size(), sigma.data(), unfit_.data(), edge_threshold, parameters.plane_threshold, sharpness.data(),
            flatness.data());
  wide.clear();
  if (parameters.smoothness == SmoothnessKind::vector_sum) {
    wide.rate(points, {each_side, neighborhood.spacing, parameters.edge_threshold}, sigma, unfit_, sharpness);
  }
  return true;
}

float LineRating::noiseThreshold(const FeatureParameters& parameters)
{
  if (parameters.smoothness != SmoothnessKind::vector_sum) {
    return parameters.edge_threshold;
  }
  constexpr std::size_t kSample = 128;  // enough for a median, and cheap
  const auto ends = static_cast<std::size_t>(each_side);
  const std::size_t step = std::max<std::size_t>(1, sigma.size() / kSample);
  sample_.clear();
  for (std::size_t n = ends; n + ends < sigma.size(); n += step) {
    if (unfit_[n] == 0) {
      sample_.push_back(sigma[n]);
    }
  }
  return std::max(parameters.edge_threshold, kNoiseRatio * medianOf(sample_));
}

}  // namespace pcl_floam
