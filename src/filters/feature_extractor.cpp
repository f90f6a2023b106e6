#include <pcl_floam/filters/feature_extractor.h>

#include "common/parameter_check.h"
#include "filters/line_points.h"
#include "filters/smoothness.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Why a point of a line cannot be a feature; bits.
enum Unfit : std::uint8_t {
  kFit = 0,
  kOutOfRange = 1,
  kOccluded = 2,  // beside a nearer surface: its neighbourhood changes with the viewpoint
  kGrazing = 4,   // on a surface seen almost edge on
  kNotAsked = 8,  // the caller wants no feature there
  kTaken = 16     // part of an edge's neighbourhood
};

/// A depth step hides surface when it is larger than this part of the range.
constexpr float kDepthStep = 0.05F;
/// Points further apart than this, in rad, have no surface between them that one could hide from the other.
constexpr float kAdjacent = 0.05F;
/// Spacing to both neighbours, as a part of the range, from which incidence is called grazing (LOAM's value).
constexpr float kGrazingSpacing = 0.0141F;

/// Scratch memory for one scan line after another.
struct LineScratch {
  LinePoints points;
  std::vector<float> sigma;
  std::vector<std::uint8_t> unfit;
  std::vector<int> candidates;
};

/// Marks the \p half_window points on the far side of each depth step.
void markOccluded(const LinePoints& line, int half_window, std::vector<std::uint8_t>& unfit)
{
  for (int n = 0; n + 1 < line.size(); ++n) {
    const auto a = static_cast<std::size_t>(n);
    const float step = line.range[a + 1] - line.range[a];
    const float nearer = std::min(line.range[a], line.range[a + 1]);
    if (std::abs(step) < kDepthStep * nearer) {
      continue;
    }
    const float lateral2 = line.squared_step[a] - step * step;
    if (lateral2 > kAdjacent * kAdjacent * nearer * nearer) {
      continue;
    }
    const int first = step > 0.0F ? n + 1 : std::max(0, n - half_window + 1);
    const int last = step > 0.0F ? std::min(line.size() - 1, n + half_window) : n;
    for (int k = first; k <= last; ++k) {
      unfit[static_cast<std::size_t>(k)] |= kOccluded;
    }
  }
}

void markUnfit(const LinePoints& line, const FeatureParameters& parameters, std::vector<std::uint8_t>& unfit)
{
  const std::size_t size = line.x.size();
  unfit.resize(size);
  const float* range = line.range.data();
  const float* squared_step = line.squared_step.data();
  // No branches: these two loops go over every point of the scan.
  for (std::size_t n = 0; n < size; ++n) {
    const bool out_of_range = (range[n] < parameters.min_range) | (range[n] > parameters.max_range);
    unfit[n] = static_cast<std::uint8_t>(out_of_range * kOutOfRange);
  }
  for (std::size_t n = 1; n + 1 < size; ++n) {
    const float limit = kGrazingSpacing * range[n];
    const bool grazing = (squared_step[n - 1] > limit * limit) & (squared_step[n] > limit * limit);
    unfit[n] = static_cast<std::uint8_t>(unfit[n] | (grazing * kGrazing));
  }
  markOccluded(line, parameters.neighbors_each_side, unfit);
}

/// Collects the features of one scan line.
class LineSelector {
public:
  LineSelector(const CloudView& cloud, const ScanLines& lines, const ScanTiming& timing,
               const FeatureParameters& parameters, const std::vector<std::uint8_t>& selectable, LineScratch& scratch,
               FeatureSet& features)
      : cloud_(cloud),
        lines_(lines),
        timing_(timing),
        parameters_(parameters),
        selectable_(selectable),
        line_(scratch),
        features_(features)
  {
  }

  void select(std::size_t m)
  {
    line_.points.gather(cloud_, lines_, m);
    if (line_.points.size() <= 2 * parameters_.neighbors_each_side) {
      return;
    }
    first_index_ = static_cast<std::size_t>(lines_.begin[m]);
    computeSmoothness(line_.points, parameters_.neighbors_each_side, parameters_.smoothness, line_.sigma);
    markUnfit(line_.points, parameters_, line_.unfit);
    markNotAsked();

    const int begin = parameters_.neighbors_each_side;
    const int length = line_.points.size() - 2 * begin;
    for (int sector = 0; sector < parameters_.sectors; ++sector) {
      const int first = begin + length * sector / parameters_.sectors;
      const int last = begin + length * (sector + 1) / parameters_.sectors;
      selectEdges(first, last);
      selectPlanes(first, last);
    }
  }

private:
  void markNotAsked()
  {
    for (std::size_t n = 0; !selectable_.empty() && n < line_.unfit.size(); ++n) {
      if (selectable_[static_cast<std::size_t>(lines_.index[first_index_ + n])] == 0) {
        line_.unfit[n] |= kNotAsked;
      }
    }
  }

  /// The points of highest smoothness, at least a neighbourhood apart.
  void selectEdges(int first, int last)
  {
    line_.candidates.clear();
    for (int n = first; n < last; ++n) {
      if (isEdge(n)) {
        line_.candidates.push_back(n);
      }
    }
    const auto sharper = [this](int a, int b) { return sigma(a) != sigma(b) ? sigma(a) > sigma(b) : a < b; };
    std::sort(line_.candidates.begin(), line_.candidates.end(), sharper);
    int taken = 0;
    for (const int n : line_.candidates) {
      if (taken == parameters_.edges_per_sector) {
        break;
      }
      if ((line_.unfit[static_cast<std::size_t>(n)] & kTaken) == 0) {
        features_.edges.push_back(makeFeature(n));
        takeNeighborhood(n);
        ++taken;
      }
    }
  }

  /// The smoothest point of each of the sector's cells: low smoothness, and evenly spread.
  void selectPlanes(int first, int last)
  {
    const int cells = parameters_.planes_per_sector;
    for (int cell = 0; cell < cells; ++cell) {
      const int from = first + (last - first) * cell / cells;
      const int to = first + (last - first) * (cell + 1) / cells;
      int best = -1;
      for (int n = from; n < to; ++n) {
        if (line_.unfit[static_cast<std::size_t>(n)] == kFit && sigma(n) < parameters_.plane_threshold &&
            (best < 0 || sigma(n) < sigma(best))) {
          best = n;
        }
      }
      if (best >= 0) {
        features_.planes.push_back(makeFeature(best));
      }
    }
  }

  [[nodiscard]] bool isEdge(int n) const
  {
    return sigma(n) > parameters_.edge_threshold && line_.unfit[static_cast<std::size_t>(n)] == kFit &&
           sigma(n) > parameters_.edge_bend * meanNeighborDistance(line_.points, n, parameters_.neighbors_each_side);
  }

  void takeNeighborhood(int n)
  {
    const int first = std::max(0, n - parameters_.neighbors_each_side);
    const int last = std::min(line_.points.size() - 1, n + parameters_.neighbors_each_side);
    for (int k = first; k <= last; ++k) {
      line_.unfit[static_cast<std::size_t>(k)] |= kTaken;
    }
  }

  [[nodiscard]] Feature makeFeature(int n) const
  {
    const auto k = static_cast<std::size_t>(n);
    Feature feature;
    feature.x = line_.points.x[k];
    feature.y = line_.points.y[k];
    feature.z = line_.points.z[k];
    feature.smoothness = line_.sigma[k];
    feature.index = lines_.index[first_index_ + k];
    feature.time = timing_.at(cloud_, static_cast<std::size_t>(feature.index));
    return feature;
  }

  [[nodiscard]] float sigma(int n) const { return line_.sigma[static_cast<std::size_t>(n)]; }

  const CloudView& cloud_;
  const ScanLines& lines_;
  const ScanTiming& timing_;
  const FeatureParameters& parameters_;
  const std::vector<std::uint8_t>& selectable_;
  LineScratch& line_;
  FeatureSet& features_;
  std::size_t first_index_ = 0;
};

}  // namespace

const char* toString(SmoothnessKind kind)
{
  return kind == SmoothnessKind::vector_sum ? "vector-sum" : "mean-of-norms";
}

void validate(const FeatureParameters& p)
{
  const ParameterCheck check("feature extraction");
  check.range("neighbors_each_side", p.neighbors_each_side, 2, 10);
  check.range("sectors", p.sectors, 1, 64);
  check.range("edges_per_sector", p.edges_per_sector, 0, 100);
  check.range("planes_per_sector", p.planes_per_sector, 0, 1000);
  check.atLeast("min_range", p.min_range, 0.0);
  check.above("max_range", p.max_range, p.min_range);
  check.atLeast("edge_threshold", p.edge_threshold, 0.0);
  check.range("edge_bend", p.edge_bend, 0.0, 1.0);
  check.above("plane_threshold", p.plane_threshold, 0.0);
}

void extractFeatures(const CloudView& cloud, const ScanLines& lines, const ScanTiming& timing,
                     const FeatureParameters& parameters, FeatureSet& features,
                     const std::vector<std::uint8_t>& selectable)
{
  features.clear();
  LineScratch scratch;
  LineSelector selector(cloud, lines, timing, parameters, selectable, scratch, features);
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    selector.select(m);
  }
}

}  // namespace pcl_floam
