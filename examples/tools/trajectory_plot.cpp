#include "trajectory_plot.h"

#include "gnuplot.h"
#include "map_sketch.h"
#include "plot_frame.h"
#include "text_format.h"

#include <pcl_floam/evaluation/trajectory_metrics.h>

#include <algorithm>

namespace pcl_floam::tools {

namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr const char* kEstimateStyle = "lines lw 2.5 lc rgb '#0b61a4'";
constexpr const char* kTruthStyle = "lines lw 5 lc rgb '#f5a742'";

/// What the panels show, in the estimate's frame.
struct PlotData {
  Points estimate;
  Points truth;
  Points paired;  ///< estimates that have a true position
  GroundArea area;
  PlotLayout layout;
};

Points positions(const std::vector<SE3>& poses)
{
  Points points(poses.size());
  std::transform(poses.begin(), poses.end(), points.begin(), [](const SE3& pose) { return pose.translation; });
  return points;
}

PlotData arrange(const TrajectoryPlot& plot)
{
  PlotData data;
  data.estimate = positions(plot.estimate);
  data.paired = positions(plot.pairs.estimate);
  const SE3 estimate_T_truth = alignTrajectories(plot.pairs.truth, plot.pairs.estimate);
  for (const SE3& pose : plot.pairs.truth) {
    data.truth.push_back(estimate_T_truth * pose.translation);
  }
  Points all = data.estimate;
  all.insert(all.end(), data.truth.begin(), data.truth.end());
  const GroundArea path = areaAround(all);
  data.layout = layoutFor(path, !data.truth.empty());
  data.area = fittedTo(path, data.layout);
  return data;
}

/// A gnuplot string: only the single quote is special.
std::string inQuotes(const std::string& text)
{
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? "''" : std::string(1, c);
  }
  return quoted + "'";
}

/// Path as a data block: distance, x, y, z, error.
std::string pathBlock(const char* name, const Points& path, const Points& reference)
{
  std::string block = formatted("$%s << EOD\n", name);
  double distance = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    distance += i > 0 ? (path[i] - path[i - 1]).norm() : 0.0;
    const Eigen::Vector3d error =
        reference.empty() ? Eigen::Vector3d(0.0, 0.0, 0.0) : Eigen::Vector3d(path[i] - reference[i]);
    block += formatted("%.3f %.3f %.3f %.4f %.4f %.4f\n", distance, path[i].x(), path[i].y(), path[i].z(), error.norm(),
                       error.head<2>().norm());
  }
  return block + "EOD\n";
}

/// The map as seen from above, no finer than the picture.
std::string mapBlock(const Points& points, const PlotData& data)
{
  constexpr double kFinestCell = 0.3;  // m; finer than the map's own voxels it would fall apart
  const double cell = std::max(kFinestCell, 2.0 * metersPerPixel(data.area, data.layout));
  std::string block = "$map << EOD\n";
  for (const Eigen::Vector2d& middle : uprightCells(points, data.area, cell)) {
    block += formatted("%.2f %.2f %.2f\n", middle.x(), middle.y(), 0.5 * cell);
  }
  return block + "EOD\n";
}

std::string preamble(const PlotLayout& layout, const std::string& title, const std::filesystem::path& image)
{
  std::string script =
      image.extension() == ".png"
          ? formatted("set terminal pngcairo noenhanced size %d,%d font 'DejaVu Sans,10' background '#ffffff'\n",
                      layout.width, layout.height)
          : formatted(
                "set terminal svg noenhanced dynamic size %d,%d font 'DejaVu Sans,Helvetica,Arial,sans-serif,13' "
                "background '#ffffff'\n",
                layout.width, layout.height);
  script += "set output " + inQuotes(image.string()) + "\nset encoding utf8\n";
  script +=
      "set multiplot\nset label 1 " + inQuotes(title) + formatted(" at screen %.4f,0.975\n", layout.top_view.left);
  script += "set border 3 lc rgb '#606060'\nset tics nomirror out scale 0.5\nset grid lc rgb '#e4e4e4' lw 1 lt 1\n";
  return script;
}

/// Puts the next plot into a panel, its key above it.
std::string placed(const Panel& panel)
{
  return formatted("set lmargin at screen %.4f\nset rmargin at screen %.4f\n", panel.left, panel.right) +
         formatted("set bmargin at screen %.4f\nset tmargin at screen %.4f\n", panel.bottom, panel.top) +
         "set key right bottom horizontal nobox samplen 2\n" +
         formatted("set key at screen %.4f,%.4f\n", panel.right, panel.top + 0.005);
}

std::string topView(const PlotData& data, bool with_map)
{
  const GroundArea& area = data.area;
  std::string script = placed(data.layout.top_view);
  script += formatted("set xrange [%.3f:%.3f]\nset yrange [%.3f:%.3f]\n", area.lowest.x(), area.highest.x(),
                      area.lowest.y(), area.highest.y());
  script += "set xlabel 'x / m' offset 0,0.4\nset ylabel 'y / m' offset 1,0\nplot ";
  if (with_map) {
    script += "$map using 1:2:3:3 with boxxyerror fs solid noborder lc rgb '#aab6c2' title 'map', ";
  }
  if (!data.truth.empty()) {
    script += formatted("$truth using 2:3 with %s title 'ground truth', ", kTruthStyle);
  }
  script += formatted("$estimate using 2:3 with %s title 'estimate', ", kEstimateStyle);
  script += "$estimate using 2:3 every ::0::0 with points pt 7 ps 1 lc rgb '#2a8f4d' title 'start', ";
  script += formatted("$estimate using 2:3 every ::%zu with points pt 5 ps 0.9 lc rgb '#b8312f' title 'end'\n",
                      data.estimate.empty() ? 0 : data.estimate.size() - 1);
  return script;
}

std::string heightPlot(const PlotData& data)
{
  const auto [lowest, highest] =
      std::minmax_element(data.estimate.begin(), data.estimate.end(),
                          [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.z() < b.z(); });
  const bool flat = data.estimate.empty() || highest->z() - lowest->z() < 0.5;
  std::string script = placed(data.layout.height_plot);
  script +=
      "set autoscale x\nset autoscale y\nset xlabel 'distance / m' offset 0,0.4\nset ylabel 'height / m' offset 1,0\n";
  script += "unset label 1\nset key off\nset xrange [0:*]\n";
  script += flat ? "set yrange [*<-0.5:0.5<*]\n" : "set yrange [*:*]\n";
  script += "plot ";
  if (!data.truth.empty()) {
    script += formatted("$truth using 1:4 with %s title 'ground truth', ", kTruthStyle);
  }
  return script + formatted("$estimate using 1:4 with %s title 'estimate'\n", kEstimateStyle);
}

std::string errorPlot(const PlotData& data)
{
  std::string script = placed(data.layout.error_plot);
  script += "set ylabel 'position error / m' offset 1,0\nset yrange [0:*]\nset key on\n";
  script += "plot $paired using 1:5 with filledcurves x1 fc rgb '#f2c9c8' notitle, ";
  script += "$paired using 1:5 with lines lw 2 lc rgb '#b8312f' title 'in all', ";
  script += "$paired using 1:6 with lines lw 1.5 dt 2 lc rgb '#404040' title 'horizontal'\n";
  return script;
}

}  // namespace

std::string plotScript(const TrajectoryPlot& plot, const std::filesystem::path& image)
{
  const PlotData data = arrange(plot);
  std::string script = pathBlock("estimate", data.estimate, {});
  script += pathBlock("truth", data.truth, {});
  script += pathBlock("paired", data.paired, data.truth);
  script += mapBlock(plot.map_points, data);
  script += preamble(data.layout, plot.title, image);
  script += topView(data, !plot.map_points.empty());
  script += heightPlot(data);
  if (!data.truth.empty()) {
    script += errorPlot(data);
  }
  return script + "unset multiplot\nunset output\n";
}

std::string drawTrajectory(const TrajectoryPlot& plot, const std::filesystem::path& image)
{
  if (plot.estimate.empty()) {
    return "there is no pose to draw";
  }
  return runGnuplot(plotScript(plot, image));
}

}  // namespace pcl_floam::tools
