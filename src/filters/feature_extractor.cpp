#include "filters/feature_selection.h"

#include "common/parameter_check.h"
#include "common/sort_key.h"
#include "filters/edge_position.h"
#include "filters/point_times.h"
#include "filters/selectability.h"
#include "filters/smoothness.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_floam {

const char* toString(SmoothnessKind kind)
{
  return kind == SmoothnessKind::vector_sum ? "vector-sum" : "mean-of-norms";
}

void validate(const FeatureParameters& p)
{
  const ParameterCheck check("feature extraction");
  check.range("edges_per_sector", p.edges_per_sector, 0, 100);
  check.range("planes_per_sector", p.planes_per_sector, 0, 1000);
  check.atLeast("min_range", p.min_range, 0.0);
  check.above("max_range", p.max_range, p.min_range);
  check.atLeast("edge_threshold", p.edge_threshold, 0.0);
  check.above("plane_threshold", p.plane_threshold, 0.0);
}

namespace {

/// Parts of a scan line, among which the features are spread, as LOAM's.
constexpr int kSectors = 6;

/// Smoothness over the mean distance to the neighbours at a blunt corner: 0 on a line, 0.7 at a right angle.
constexpr float kBend = 0.35F;

/// Of the smoothness that makes an edge, so much must lie across the line. Where a surface steps back by a hand's
/// breadth, as at a door, about a third does.
constexpr float kAcross = 0.3F;

/// The first place of the least of some numbers that are not negative.
int placeOfLeast(const std::vector<float>& numbers, int first, int last)
{
  // Bits of such floats rise with their values: number and place together are compared at once, without a branch.
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (int n = first; n < last; ++n) {
    least = std::min(least, sortKey(numbers[static_cast<std::size_t>(n)], static_cast<std::uint32_t>(n)));
  }
  return static_cast<int>(static_cast<std::uint32_t>(least));
}

/// Collects the features of one scan line.
class LineSelector {
public:
  LineSelector(const CloudView& cloud, const ScanLines& lines, const ScanTiming& timing,
               const FeatureParameters& parameters, const std::vector<std::uint8_t>& selectable,
               FeatureSelection& selection)
      : cloud_(cloud),
        lines_(lines),
        timing_(timing),
        parameters_(parameters),
        selectable_(selectable),
        line_(selection.line),
        features_(selection.features),
        candidates_(selection.candidates)
  {
  }

  void select(std::size_t m)
  {
    first_index_ = static_cast<std::size_t>(lines_.begin[m]);
    if (!line_.rate(cloud_, lines_, m, parameters_, selectable_)) {
      return;
    }
    line_number_ = static_cast<std::int32_t>(m);
    neighbors_ = line_.each_side;
    const int begin = neighbors_;
    const int length = line_.points.size() - 2 * begin;
    for (int sector = 0; sector < kSectors; ++sector) {
      const int first = begin + length * sector / kSectors;
      const int last = begin + length * (sector + 1) / kSectors;
      selectEdges(first, last);
      selectPlanes(first, last);
    }
  }

private:
  /// The points of highest smoothness, at least a neighbourhood apart. Most candidates are never looked at closely.
  void selectEdges(int first, int last)
  {
    findEdgeCandidates(first, last);
    const auto isLess = [](const EdgeCandidate& a, const EdgeCandidate& b) {
      return a.sharpness != b.sharpness ? a.sharpness < b.sharpness : a.place > b.place;
    };
    std::vector<EdgeCandidate>& heap = candidates_;
    std::make_heap(heap.begin(), heap.end(), isLess);
    for (int taken = 0; taken < parameters_.edges_per_sector && !heap.empty(); heap.pop_back()) {
      std::pop_heap(heap.begin(), heap.end(), isLess);
      const int sharpest = heap.back().place;
      if (isEdge(sharpest)) {
        takeEdge(sharpest);
        ++taken;
      }
    }
  }

  void findEdgeCandidates(int first, int last)
  {
    constexpr int kStretch = 16;  // most have none
    candidates_.clear();
    for (int begin = first; begin < last; begin += kStretch) {
      const int end = std::min(last, begin + kStretch);
      int any = 0;
      for (int n = begin; n < end; ++n) {
        any |= sharpness(n) > 0.0F ? 1 : 0;
      }
      for (int n = begin; n < end && any != 0; ++n) {
        if (sharpness(n) > 0.0F) {
          candidates_.push_back({sharpness(n), n});
        }
      }
    }
  }

  [[nodiscard]] bool isEdge(int n) const
  {
    if (!(sharpness(n) > 0.0F)) {  // in the neighbourhood of one taken since
      return false;
    }
    if (parameters_.smoothness != SmoothnessKind::vector_sum) {  // a mean of norms is 1 on a line as well
      return true;
    }
    if (line_.wide.isEdge(n)) {
      return true;
    }
    const float distance = meanNeighborDistance(line_.points, n, neighbors_);
    if (!(sharpness(n) > kBend * distance)) {
      return false;
    }
    // Where returns are missing, a straight line's neighbours are nearer on one side: its sum is long, but along it.
    const float across = meanDifferenceAcross(line_.points, n, neighbors_);
    return isBesideDepthStep(line_.points, n) || across > kAcross * std::max(line_.edge_threshold, kBend * distance);
  }

  /// The smoothest point of each of the sector's cells: low smoothness, and evenly spread.
  void selectPlanes(int first, int last)
  {
    const int cells = parameters_.planes_per_sector;
    for (int cell = 0; cell < cells; ++cell) {
      const int from = first + (last - first) * cell / cells;
      const int to = first + (last - first) * (cell + 1) / cells;
      if (from == to) {
        continue;
      }
      const int smoothest = placeOfLeast(line_.flatness, from, to);
      if (line_.flatness[static_cast<std::size_t>(smoothest)] < kNeverFlat) {
        features_.planes.push_back(makeFeature(smoothest));
      }
    }
  }

  void takeEdge(int sharpest)
  {
    const LineEdge edge = locateEdge(line_.points, sharpest, line_.edge_threshold);
    Feature feature = makeFeature(sharpest);
    feature.x = edge.position.x();
    feature.y = edge.position.y();
    feature.z = edge.position.z();
    feature.time = timeOf(edge.middle());
    features_.edges.push_back(feature);
    // What is part of its neighbourhood is neither another edge nor a plane.
    const int first = std::max(0, std::min(sharpest, edge.first) - neighbors_);
    const int last = std::min(line_.points.size() - 1, std::max(sharpest, edge.last) + neighbors_);
    for (int k = first; k <= last; ++k) {
      line_.sharpness[static_cast<std::size_t>(k)] = 0.0F;
      line_.flatness[static_cast<std::size_t>(k)] = kNeverFlat;
    }
    line_.wide.forgetAround(line_.points, sharpest, line_.sharpness);
  }

  [[nodiscard]] Feature makeFeature(int n) const
  {
    constexpr float kEnd = 1.0F;  // unless there are times
    const auto k = static_cast<std::size_t>(n);
    const std::int32_t index = lines_.index[first_index_ + k];
    const float intensity = cloud_.intensityOf(static_cast<std::size_t>(index));
    const LinePoints& points = line_.points;
    return {points.x[k], points.y[k], points.z[k], kEnd, line_.sigma[k], index, intensity, line_number_};
  }

  [[nodiscard]] float timeOf(int n) const
  {
    return timing_.at(cloud_, static_cast<std::size_t>(lines_.index[first_index_ + static_cast<std::size_t>(n)]));
  }

  [[nodiscard]] float sharpness(int n) const { return line_.sharpness[static_cast<std::size_t>(n)]; }

  const CloudView& cloud_;
  const ScanLines& lines_;
  const ScanTiming& timing_;
  const FeatureParameters& parameters_;
  const std::vector<std::uint8_t>& selectable_;
  LineRating& line_;
  FeatureSet& features_;
  std::vector<EdgeCandidate>& candidates_;
  std::int32_t line_number_ = 0;
  std::size_t first_index_ = 0;
  int neighbors_ = 0;  ///< on each side, in this line
};

}  // namespace

void extractFeatures(const CloudView& cloud, const ScanLines& lines, const ScanTiming& timing,
                     const FeatureParameters& parameters, FeatureSet& features,
                     const std::vector<std::uint8_t>& selectable, int threads)
{
  std::vector<FeatureSelection> selections;
  extractFeatures(cloud, lines, timing, parameters, selectable, threads, selections, features);
}

void extractFeatures(const CloudView& cloud, const ScanLines& lines, const ScanTiming& timing,
                     const FeatureParameters& parameters, const std::vector<std::uint8_t>& selectable, int threads,
                     std::vector<FeatureSelection>& selections, FeatureSet& features)
{
  // Each part takes lines that follow each other, so that the parts' features, one after the other, are in the order
  // of the lines for every number of parts. Lines that look at the sky are done sooner: more parts than threads.
  constexpr std::size_t kPartsPerThread = 4;
  const std::size_t wanted = threads > 1 ? kPartsPerThread * static_cast<std::size_t>(threads) : 1;
  const std::size_t parts = std::min(wanted, lines.lines());
  selections.resize(std::max(parts, selections.size()));
  features.clear();
  if (parts > 0) {
    std::swap(selections.front().features, features);  // its memory is used again
  }
#pragma omp parallel for num_threads(std::max(threads, 1)) schedule(dynamic, 1)
  for (std::size_t part = 0; part < parts; ++part) {
    FeatureSelection& selection = selections[part];
    selection.features.clear();
    LineSelector selector(cloud, lines, timing, parameters, selectable, selection);
    for (std::size_t m = lines.lines() * part / parts; m < lines.lines() * (part + 1) / parts; ++m) {
      selector.select(m);
    }
    setTimes(cloud, timing, selection.features.planes);
  }
  if (parts > 0) {
    std::swap(selections.front().features, features);
  }
  for (std::size_t part = 1; part < parts; ++part) {
    const FeatureSet& found = selections[part].features;
    features.edges.insert(features.edges.end(), found.edges.begin(), found.edges.end());
    features.planes.insert(features.planes.end(), found.planes.begin(), found.planes.end());
  }
}

}  // namespace pcl_floam
