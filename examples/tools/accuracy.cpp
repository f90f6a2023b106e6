#include "accuracy.h"

#include "text_format.h"

namespace pcl_floam::tools {

namespace {

KittiMetric measureKitti(const PosePairs& pairs, const AccuracyOptions& options)
{
  if (options.lengths.empty() && options.step == 0) {
    return fittingKittiMetric(pairs.estimate, pairs.truth);
  }
  const std::vector<double> lengths = options.lengths.empty() ? lengthsFor(pathLength(pairs.truth)) : options.lengths;
  const std::size_t fitting_step = lengths == kittiLengths() ? 10 : 1;
  return kittiMetric(pairs.estimate, pairs.truth, lengths, options.step > 0 ? options.step : fitting_step);
}

Json toJson(const ErrorStatistics& errors)
{
  return {{"rms", errors.rms},
          {"mean", errors.mean},
          {"median", errors.median},
          {"max", errors.max},
          {"count", errors.count}};
}

Json toJson(const KittiMetric& kitti)
{
  Json lengths = Json::array();
  for (const SegmentErrors& errors : kitti.lengths) {
    lengths.push_back({{"length_m", errors.length},
                       {"t_rel_percent", errors.translation},
                       {"r_rel_deg_per_100m", errors.rotation},
                       {"segments", errors.segments}});
  }
  const bool any = kitti.segments > 0;
  return {{"t_rel_percent", any ? Json(kitti.translation) : Json()},
          {"r_rel_deg_per_100m", any ? Json(kitti.rotation) : Json()},
          {"segments", kitti.segments},
          {"step", kitti.step},
          {"standard_lengths", kitti.standard_lengths},
          {"lengths", lengths}};
}

std::string describeErrors(const char* name, const ErrorStatistics& errors, const char* unit)
{
  return formatted("%-22s rms %.4f   mean %.4f   median %.4f   max %.4f %s", name, errors.rms, errors.mean,
                   errors.median, errors.max, unit);
}

}  // namespace

Accuracy measureAccuracy(const PosePairs& pairs, const AccuracyOptions& options)
{
  Accuracy accuracy;
  accuracy.options = options;
  accuracy.poses = pairs.size();
  accuracy.path_length = pathLength(pairs.truth);
  accuracy.kitti = measureKitti(pairs, options);
  accuracy.standard = kittiMetric(pairs.estimate, pairs.truth);
  accuracy.ate = absoluteTrajectoryError(pairs.estimate, pairs.truth, options.align);
  accuracy.rpe = relativePoseError(pairs.estimate, pairs.truth, options.rpe_step);
  return accuracy;
}

std::string describeLengths(const Accuracy& accuracy)
{
  const KittiMetric& kitti = accuracy.kitti;
  if (kitti.lengths.empty()) {
    return "no sub-sequence fits";
  }
  const std::string start = kitti.step == 1 ? "every pose" : formatted("every %zuth pose", kitti.step);
  return formatted("%zu sub-sequences of %g to %g m, from %s", kitti.segments, kitti.lengths.front().length,
                   kitti.lengths.back().length, start.c_str());
}

std::string describeStandard(const Accuracy& accuracy)
{
  if (accuracy.kitti.standard_lengths) {
    return "KITTI's standard: 100 to 800 m, from every 10th pose";
  }
  const bool chosen = !accuracy.options.lengths.empty() || accuracy.options.step > 0;
  return chosen ? "not KITTI's standard of 100 to 800 m: does not compare with its tables"
                : "the run is too short for KITTI's 100 to 800 m: does not compare with its tables";
}

std::string describe(const Accuracy& accuracy)
{
  const KittiMetric& kitti = accuracy.kitti;
  std::string text = formatted("%-22s %zu, path %.1f m", "poses compared", accuracy.poses, accuracy.path_length);
  if (kitti.segments > 0) {
    text +=
        formatted("\n%-22s t_rel %.3f %%   r_rel %.3f deg/100 m", "KITTI metric", kitti.translation, kitti.rotation);
  } else {
    text += formatted("\n%-22s none", "KITTI metric");
  }
  text += formatted("\n%-22s %s", "", describeLengths(accuracy).c_str());
  text += formatted("\n%-22s %s", "", describeStandard(accuracy).c_str());
  if (!kitti.standard_lengths && accuracy.standard.segments > 0) {
    const KittiMetric& standard = accuracy.standard;
    text += formatted("\n%-22s t_rel %.3f %%   r_rel %.3f deg/100 m by that standard, %zu sub-sequence%s only", "",
                      standard.translation, standard.rotation, standard.segments, standard.segments == 1 ? "" : "s");
  }
  text += "\n" + describeErrors(accuracy.options.align ? "ATE, SE(3) aligned" : "ATE, first pose", accuracy.ate, "m");
  const std::size_t step = accuracy.options.rpe_step;
  const std::string rpe = formatted("RPE over %zu pose%s", step, step == 1 ? "" : "s");
  text += "\n" + describeErrors(rpe.c_str(), accuracy.rpe.translation, "m");
  text += "\n" + describeErrors("", accuracy.rpe.rotation, "deg");
  return text;
}

Json toJson(const Accuracy& accuracy)
{
  Json json;
  json["poses"] = accuracy.poses;
  json["path_length_m"] = accuracy.path_length;
  json["kitti"] = toJson(accuracy.kitti);
  json["kitti"]["note"] = describeLengths(accuracy) + "; " + describeStandard(accuracy);
  if (!accuracy.kitti.standard_lengths) {
    json["kitti_standard_lengths"] = toJson(accuracy.standard);
  }
  json["ate"] = {{"alignment", accuracy.options.align ? "se3" : "first"}, {"position_m", toJson(accuracy.ate)}};
  json["rpe"] = {{"step", accuracy.options.rpe_step},
                 {"translation_m", toJson(accuracy.rpe.translation)},
                 {"rotation_deg", toJson(accuracy.rpe.rotation)}};
  return json;
}

}  // namespace pcl_floam::tools
