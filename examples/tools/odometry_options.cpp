#include "odometry_options.h"

#include "command_line.h"

#include <type_traits>

namespace pcl_floam::tools {

namespace {

/// A number with its unit, its default shown.
template <typename Number>
void addNumber(CLI::App& app, const std::string& option, Number& value, const std::string& unit,
               const std::string& description)
{
  CLI::Option* added = app.add_option(option, value, description)->type_name(unit)->capture_default_str();
  if (std::is_unsigned_v<Number>) {
    added->check(notNegative());
  }
}

/// Words in lines that a terminal shows whole.
std::string wrapped(const std::vector<std::string>& words)
{
  constexpr std::size_t kWidth = 60;
  std::string text;
  std::size_t line_begin = 0;
  for (const std::string& word : words) {
    const bool fits = text.size() + 1 + word.size() - line_begin <= kWidth;
    text += text.empty() ? "" : (fits ? " " : "\n");
    line_begin = fits ? line_begin : text.size();
    text += word;
  }
  return text;
}

void addInputOptions(CLI::App& app, OdometryOptions& o)
{
  app.option_defaults()->group("Scans");
  app.add_option("SCANS", o.scans,
                 "folder of .pcd scans or of KITTI's .bin scans; or a recording:\n"
                 "mcap, rosbag (1 or 2), pcap of Velodyne packets")
      ->required()
      ->type_name("PATH");
  app.add_option("--topic", o.topic, "topic of the scans, where a recording has several")->type_name("NAME");
  addNumber(app, "--from", o.from, "N", "first scan to use; the folder's first is 0");
  addNumber(app, "--max-scans", o.max_scans, "N", "use at most so many scans; 0 uses all");
  app.add_option("--sensor", o.sensor,
                 "lidar that made the scans; solid-state: scan lines are not\nlooked for\n" + wrapped(sensorNames()))
      ->type_name("NAME")
      ->capture_default_str();
  app.add_option("--elevations", o.elevations, "beams of a lidar not in that list, e.g. -15,-13,-11")
      ->type_name("DEG,DEG,...")
      ->delimiter(',')
      ->excludes("--sensor");
  app.add_option(
         "--sensor-pose", o.sensor_pose,
         "where the sensor is in the scans' frame, if that is not its\nown but a vehicle's: x,y,z,roll,pitch,yaw in m "
         "and degrees;\nposes are the vehicle's")
      ->type_name("X,Y,Z,R,P,Y")
      ->delimiter(',')
      ->expected(6);
  addNumber(app, "--scan-period", o.parameters.scan_period, "S",
            "time from scan to scan; 0 takes it from times.txt,\nand 0.1 s for time stamps without that file");
  addNumber(app, "--vertical-correction", o.parameters.vertical_correction, "DEG",
            "turn every point up by this angle: corrects the\nsensor's calibration; KITTI's needs about 0.205");
}

void addTimingOptions(CLI::App& app, OdometryOptions& o)
{
  app.option_defaults()->group("Times within a scan (found automatically)");
  addChoice(app, "--timing", o.parameters.timing_source,
            {{"auto", ScanTimingSource::automatic},
             {"field", ScanTimingSource::time_field},
             {"columns", ScanTimingSource::columns},
             {"azimuth", ScanTimingSource::azimuth},
             {"clockwise", ScanTimingSource::clockwise},
             {"counterclockwise", ScanTimingSource::counterclockwise},
             {"none", ScanTimingSource::none}},
            "where the points' times come from; (counter)clockwise: from the\n"
            "azimuth, the head turning so, seen from above");
}

void addPriorMapOptions(CLI::App& app, OdometryOptions& o)
{
  app.option_defaults()->group("A map from an earlier run");
  CLI::Option* map =
      app.add_option("--map", o.map,
                     "folder with map_edges.pcd and map_planes.pcd: poses are found\nin that map, which grows")
          ->type_name("FOLDER");
  app.add_flag("--localize", o.localize, "leave that map as it is")->needs(map);
  app.add_option("--initial-pose", o.initial_pose,
                 "where in that map the first scan is, within about 2 m and\n10 degrees: x,y,z,yaw in m and degrees; "
                 "default 0,0,0,0")
      ->type_name("X,Y,Z,YAW")
      ->delimiter(',')
      ->expected(4)
      ->needs(map);
}

void addResultOptions(CLI::App& app, OdometryOptions& o)
{
  app.option_defaults()->group("Results");
  app.add_option("-o,--output", o.output, "folder for the results; created if need be")
      ->required()
      ->type_name("FOLDER");
  app.add_option("--ground-truth", o.ground_truth,
                 "true poses, KITTI or TUM format: adds accuracy and plots.\n"
                 "TUM by time, where the scans have times; else one pose per scan")
      ->type_name("FILE");
  app.add_option("--calibration", o.calibration,
                 "of a Velodyne HDL-64, to decode its packets: its db.xml or\nYAML. Or KITTI's calib.txt, "
                 "when the true poses are the\ncamera's, as in the KITTI odometry benchmark")
      ->type_name("FILE");
  addChoice(app, "--pose-instant", o.pose_instant,
            {{"auto", std::nullopt},
             {"start", PoseInstant::start},
             {"middle", PoseInstant::middle},
             {"end", PoseInstant::end}},
            "instant of the sweep that the poses describe; auto is the\n"
            "middle for KITTI's .bin, whose ground truth is mid-sweep,\nand the end otherwise");
  app.add_option("--save-scans", o.save_scans,
                 "new or empty folder for the scans without their\ndistortion, as PCD, and times.txt")
      ->type_name("FOLDER");
  app.add_flag("--ply", o.ply, "the path and the map as path.ply and map.ply, too");
  CLI::Option* grid = app.add_option("--grid", o.grid,
                                     "an occupancy grid (grid.pgm, grid.yaml) of what stands between\n"
                                     "these heights, in the world's frame: for example -0.5,1.0")
                          ->type_name("M,M")
                          ->delimiter(',')
                          ->expected(2);
  app.add_option("--grid-cell", o.grid_cell, "edge of the grid's cells")
      ->type_name("M")
      ->capture_default_str()
      ->check(positive())
      ->needs(grid);
  addChoice(app, "--plot", o.plot, {{"svg", ".svg"}, {"png", ".png"}, {"none", ""}},
            "format of the picture of path, height and error");
}

constexpr const char* kPoseEstimation = "Pose estimation (but for --planar, of --engine features)";

/// What would have no effect is a mistake.
void refuseWithoutFeatures(const CLI::App& app, const OdometryOptions& o)
{
  for (const CLI::Option* option : app.get_options()) {
    const std::string& group = option->get_group();
    const bool of_features = group == kPoseEstimation;
    if (o.parameters.engine != OdometryEngine::features && of_features && option->count() > 0 &&
        !option->check_lname("planar")) {
      throw CLI::ValidationError(option->get_name(), "has an effect with --engine features only");
    }
  }
}

void addCompensationOptions(CLI::App& app, OdometryOptions& o)
{
  app.option_defaults()->group("Motion compensation");
  addChoice(app, "--engine", o.parameters.engine,
            {{"surfaces", OdometryEngine::surfaces}, {"features", OdometryEngine::features}},
            "what scans are registered by; surfaces hold on open roads\n"
            "and need no scan lines; features are the paper's pipeline");
  addChoice(app, "--compensation", o.parameters.compensation,
            {{"continuous", CompensationMode::continuous},
             {"two-stage", CompensationMode::two_stage},
             {"loam", CompensationMode::iterative},
             {"none", CompensationMode::none}},
            "how the sweep's distortion is undone; none for scans that\n"
            "are compensated already (KITTI odometry benchmark)");
}

void addFeatureOptions(CLI::App& app, FeatureParameters& p)
{
  app.option_defaults()->group("Features");
  addChoice(app, "--smoothness", p.smoothness,
            {{"vector-sum", SmoothnessKind::vector_sum}, {"mean-of-norms", SmoothnessKind::mean_of_norms}},
            "reading of Eq. 1: LOAM's, or as printed");
  addNumber(app, "--edges-per-sector", p.edges_per_sector, "N", "most edges in a sixth of a scan line");
  addNumber(app, "--planes-per-sector", p.planes_per_sector, "N", "most planes in a sixth of a scan line");
  addNumber(app, "--min-range", p.min_range, "M", "nearer points are left out");
  addNumber(app, "--max-range", p.max_range, "M", "farther points are left out");
  addNumber(app, "--edge-threshold", p.edge_threshold, "M", "smoothness that an edge must exceed");
  addNumber(app, "--plane-threshold", p.plane_threshold, "M", "smoothness that a plane must not exceed");
}

void addSolverOptions(CLI::App& app, RegistrationParameters& p)
{
  app.option_defaults()->group(kPoseEstimation);
  addChoice(app, "--solver", p.solver, {{"gauss-newton", SolverKind::gauss_newton}, {"ceres", SolverKind::ceres}},
            "least-squares solver");
  addChoice(
      app, "--weights", p.weights,
      {{"uniform", WeightScheme::uniform}, {"inverted", WeightScheme::inverted}, {"printed", WeightScheme::printed}},
      "smoothness weights of Eq. 9; inverted is what its text\nwants, printed is the formula");
  addChoice(app, "--kernel", p.kernel,
            {{"none", RobustKernel::none},
             {"huber", RobustKernel::huber},
             {"cauchy", RobustKernel::cauchy},
             {"geman-mcclure", RobustKernel::geman_mcclure}},
            "robust kernel on the residuals");
  app.add_flag_callback(
      "--planar", [&p] { p.locked = kPlanarMotion; },
      "the sensor's height, roll and pitch stay as they begin;\na 2-D lidar needs it");
}

void addMapOptions(CLI::App& app, OdometryParameters& p)
{
  app.option_defaults()->group("Map");
  addNumber(app, "--keyframe-translation", p.keyframe.translation, "M",
            "a scan enters the map after this way,\nor a turn by which what is 5 m away moves so far");
  addNumber(app, "--voxel-size", p.map.voxel_size, "M",
            "one plane point is kept per voxel of this size; edges' are half as wide");
  addNumber(app, "--horizon", p.map.horizon, "M", "the map forgets what is farther from the sensor");
  addNumber(app, "--see-through-range", p.map.see_through_range, "M",
            "up to so far away, the map forgets places that later scans see through: what has gone; 0: never");
  addChoice(app, "--search", p.map.search, {{"voxel", SearchMethod::voxel}, {"kdtree", SearchMethod::kdtree}},
            "nearest-neighbour search; both find the same points");
}

void addRunOptions(CLI::App& app, OdometryOptions& o)
{
  app.option_defaults()->group("Run");
  addNumber(app, "--threads", o.parameters.threads, "N", "threads; the result does not depend on it");
  addNumber(app, "--start-effort", o.parameters.start_effort, "N",
            "registrations that the start adds to those of one scan");
  app.add_flag("-q,--quiet", o.quiet, "no progress and no summary; problems are still told");
  app.set_help_flag("-h,--help", "this help")->group("Run");
  app.set_version_flag("--version", PCL_FLOAM_VERSION)->group("Run");
}

}  // namespace

void addOptions(CLI::App& app, OdometryOptions& options)
{
  addInputOptions(app, options);
  addPriorMapOptions(app, options);
  addTimingOptions(app, options);
  addResultOptions(app, options);
  addCompensationOptions(app, options);
  addFeatureOptions(app, options.parameters.features);
  addSolverOptions(app, options.parameters.registration);
  addMapOptions(app, options.parameters);
  addRunOptions(app, options);
  app.parse_complete_callback([&app, &options] { refuseWithoutFeatures(app, options); });
}

OdometryParameters parametersFor(const OdometryOptions& options, ScanFormat format)
{
  OdometryParameters parameters = options.parameters;
  parameters.sensor =
      options.elevations.empty() ? sensorModel(options.sensor) : customSensor("custom", options.elevations);
  const PoseInstant fitting = format == ScanFormat::kitti_bin ? PoseInstant::middle : PoseInstant::end;
  parameters.pose_instant = options.pose_instant.value_or(fitting);
  validate(parameters);
  return parameters;
}

}  // namespace pcl_floam::tools
