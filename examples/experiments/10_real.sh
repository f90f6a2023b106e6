#!/usr/bin/env bash
# Real drives: pcl_floam and PCL's ICP, GICP and NDT on the same scans; then the same methods on simulated twins of three
# of them, and by how much the errors differ.
#
#   bash examples/experiments/10_real.sh DATA_DIR [--quick] [--data DIR] [--output DIR]
#
# Of DATA_DIR those of these folders are taken that are there:
#   kitti_raw_0001/velodyne, poses.txt   KITTI raw 2011_09_26_drive_0001; --vertical-correction 0.205
#   kitti_odom_01_ramp/velodyne, poses.txt   KITTI odometry 01, scans 37 to 76; the same and --compensation none
#   kitti_raw_0048_pcd                   KITTI raw 2011_09_26_drive_0048 as PCD, no truth; --vertical-correction 0.205
#   vlp16_static/pcd                     a VLP-16 that stands: all that moves is error
#   hdl32e_fog/pcd                       an HDL-32E in fog, no truth
# PCL's methods get the same correction.
#
# Twins, three seeds each, all of the family `report` with the errors of real lasers:
#   kitti_raw_0001      town along the real drive's own poses, HDL-64, .bin without times
#   kitti_odom_01_ramp  motorway along KITTI's path 01 from the same scan (DATA_DIR/kitti_odom_paths/01.txt), HDL-64,
#                       compensated, in the layout of KITTI's benchmark
#   vlp16_static        yard, VLP-16, standing, the carrier 0.8 m behind it
# Ranges are as noisy as those of the real sensors on still planes: 1.3 cm (HDL-64), 1 cm (VLP-16); KITTI's end at 80 m.
# The true poses of twins that drive get the errors that the makers of the real ones state of their GPS (real.py), before
# anything is judged by them: without these no method errs on a twin as little as the real truth itself does.
# Where pcl_floam_evaluate offers --scans, the table tells how sharp a map the poses make: of pcl_floam's undistorted
# scans, of PCL's methods' scans as these got them.
# At rest wander is the greatest distance from the first pose, jitter the change from scan to scan, root mean square.
# A ratio of errors, real to the twins' median, between 2/3 and 1.5 is called alike. The real truth of kitti_raw_0001 is good to
# 0.4 % and 5.5 cm, that of the ramp to 0.3 % and 9 cm: smaller errors there are the truth's.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *
from real import as_by_gps, at_rest, camera_way, first_scans, ratio, sharpness

LIFT = "0.205"  # degrees, of KITTI's HDL-64
RAISED = ["--vertical-correction", LIFT]
# folder: scans in it, sensor, options, whether there is truth, whether it stands
DRIVES = {"kitti_raw_0001": ("velodyne", "hdl64", RAISED, True, False),
          "kitti_odom_01_ramp": ("velodyne", "hdl64", RAISED + ["--compensation", "none"], True, False),
          "kitti_raw_0048_pcd": (".", "hdl64", RAISED, False, False),
          "vlp16_static": ("pcd", "vlp16", [], False, True),
          "hdl32e_fog": ("pcd", "hdl32", [], False, False)}
METHODS = {"pcl_floam": None, "ICP": "icp", "GICP": "gicp", "NDT": "ndt"}
OUTDOORS = ["--leaf", "0.5", "--resolution", "2.0"]
QUICK_SCANS = 12
RAMP_START = 36.6  # m, of path 01 before its scan 37
ALIKE = 1.5
HDL64 = ["--noise", 0.013, "--reach", 80]  # of the twins of KITTI's


def arguments(parser):
    parser.add_argument("drives", type=pathlib.Path, nargs="?", metavar="DATA_DIR")


def titled(name):
    """Of data, which are shorter in quick runs."""
    return name + (f"-first{QUICK_SCANS}" if options.quick else "")


class Drive:
    """One drive, as pcl_floam gets it and as PCL's methods do, with the options of theirs that it asks for."""

    def __init__(self, name, ours, theirs=None, stands=False, extra=()):
        self.name, self.ours, self.theirs, self.stands = name, ours, theirs or ours, stands
        self.extra = OUTDOORS + list(extra)

    def runs(self):
        result = [Run(self.theirs if method else self.ours, label, self.extra if method else [], method, self._judge)
                  for label, method in METHODS.items()]
        # In the run's folder, which is emptied before.
        result[0].arguments += ["--save-scans", str(options.output / "runs" / result[0].name / "scans")]
        return result

    def _judge(self, run):
        if not (run.folder / "poses.kitti.txt").exists():
            return {}
        places = positions(run.folder / "poses.kitti.txt")[1]
        figures = {"way": sum(map(math.dist, places, places[1:])), **(at_rest(options, run.folder) if self.stands else {})}
        scans = run.data.scans if run.method else run.folder / "scans"
        return {**figures, **sharpness(options, run.folder, scans)}


def real_drive(name):
    """None if it is not there."""
    scans, sensor, extra, has_truth, stands = DRIVES[name]
    about = {"world": "real", "sensor": sensor, "options": extra}
    if options.tables_only:
        data = Dataset(titled(name), None, None, **about)
        return Drive(name, data, stands=stands) if data.name in known else None
    folder = options.arguments.drives / name / scans
    if not folder.is_dir():
        return None
    truth = options.arguments.drives / name / "poses.txt" if has_truth else None
    if options.quick:
        folder, truth = first_scans(folder, truth, options.arguments.data / titled(name), QUICK_SCANS)
    ours = Dataset(titled(name), folder, truth, odometry_options=extra, **about)
    return Drive(name, ours, Dataset(titled(name), folder, truth, **about), stands, RAISED if extra else [])


class Twin:
    """How the simulator makes one: what it writes where, and what there is to be told of it."""

    def __init__(self, world, sensor, seeds, count, extra, scans, truths, calibration=None, odometry=(), stands=False):
        self.world, self.sensor, self.seeds, self.scans, self.truths = world, sensor, seeds, scans, truths
        self.extra = [str(word) for word in extra + ["--scans", QUICK_SCANS if options.quick else count]]
        self.calibration, self.odometry, self.stands = calibration, odometry, stands

    def drives(self, name):
        """One for each seed."""
        for seed in self.seeds[:1 if options.quick else None]:
            title = titled(f"twin-{name}-seed{seed}")
            if options.tables_only and title not in known:
                continue
            folder = options.arguments.data / title
            if not options.tables_only and not (folder / self.truths[0]).exists():
                make(options, folder, [self.world, "--sensor", self.sensor, "--seed", seed, "--family", "report",
                                       "--realism", "real"] + self.extra)
            truths = [folder / truth for truth in self.truths]
            if not options.tables_only and not self.stands:
                by_gps = folder / "poses_by_gps.txt"
                truths = 2 * [as_by_gps(truths[1], by_gps, seed, 1 if self.calibration else 2)]
            data = Dataset(title, folder / self.scans, *truths, self.odometry,
                           self.calibration and folder / self.calibration, world=self.world, sensor=self.sensor,
                           family="report", seed=seed, options=self.extra)
            yield Drive("twin of " + name, data, stands=self.stands)


def twin_of(name):
    """None if there is none, or not what it needs."""
    root = options.arguments.drives or pathlib.Path()
    if name == "kitti_raw_0001":
        way = options.arguments.data / "kitti_raw_0001-way.txt"
        if not options.tables_only:
            camera_way(root / name / "poses.txt", way)
        return Twin("town", "hdl64", [981, 982, 983], 107, ["--trajectory", way, "--format", "kitti"] + HDL64,
                    "velodyne", ("poses_middle.txt", "poses_middle.txt"))
    path = root / "kitti_odom_paths/01.txt"
    if name == "kitti_odom_01_ramp" and (path.exists() or options.tables_only):
        return Twin("motorway", "hdl64", [984, 985, 986], 40,
                    ["--trajectory", path, "--from", RAMP_START, "--length", 250, "--format", "kitti-odometry",
                     "--sequence", "01"] + HDL64,
                    "sequences/01/velodyne", ("poses/01.txt", "poses/01.txt"), "sequences/01/calib.txt",
                    ["--compensation", "none"])
    if name == "vlp16_static":
        return Twin("yard", "vlp16", [987, 988, 989], 80,
                    ["--standing", "0", "--start", 12, "--carrier", 0.8, "--noise", 0.01], "scans",
                    ("poses_end.txt", "poses_middle.txt"), stands=True)
    return None


def rows_of(drives):
    """One for each method; several twins of one drive side by side."""
    for label, *same in zip(METHODS, *(runs[drive.ours.name] for drive in drives)):
        side_by_side = lambda key, digits, factor=1: " ".join(number(run.figures[key], digits, factor) for run in same)
        row = [drives[0].name, drives[0].ours.description["sensor"], label, side_by_side("way", 1)]
        row += ["–", "–"] if drives[0].stands else [side_by_side("t_rel", 3), side_by_side("ate", 1, 100)]
        row += [side_by_side("wander", 1, 100), side_by_side("jitter", 1, 1000)] if drives[0].stands else ["–", "–"]
        row += [number(statistics.median(times), 1) if (times := list(values_of(same, "ms"))) else "–"]
        yield row + [side_by_side("spread", 2, 100), side_by_side("entropy", 3)]


def values_of(members, key):
    return (run.figures[key] for run in members if run.figures[key] is not None)


def compared(name):
    """One row for each method and figure that a drive and its twins have; the twins' median counts."""
    figures = (("wander / cm", "wander", 2, 100), ("jitter / mm", "jitter", 2, 1000)) if drives[name].stands else (
        ("t_rel / %", "t_rel", 3, 1), ("ATE / cm", "ate", 2, 100))
    for title, key, digits, factor in figures + (("spread / cm", "spread", 2, 100),):
        for real_run, *same in zip(runs[drives[name].ours.name], *(runs[drive.ours.name] for drive in twins[name])):
            values = list(values_of(same, key))
            median = statistics.median(values) if values else None
            found = ratio(real_run.figures[key], median)
            if found is not None:
                yield [name, real_run.label, title, number(real_run.figures[key], digits, factor),
                       number(median, digits, factor), number(found, 3),
                       "yes" if 1.0 / ALIKE <= found <= ALIKE else "**no**"]


options = Options("10_real", "real drives and their twins, with PCL's methods beside", arguments)
if not options.arguments.drives and not options.tables_only:
    sys.exit("DATA_DIR is missing: the folder of the real drives")
known = options.records.of_data("name")
drives = {name: drive for name in DRIVES if (drive := real_drive(name))}
if not drives:
    sys.exit(f"{options.arguments.drives or options.output}: none of {', '.join(DRIVES)}")
twins = {name: made for name in drives if (kind := twin_of(name)) and (made := list(kind.drives(name)))}
runs = {drive.ours.name: execute(options, drive.runs(), timed=True)
        for drive in list(drives.values()) + [drive for same in twins.values() for drive in same]}
header = ["drive", "sensor", "method", "way / m", "t_rel / %", "ATE / cm", "wander / cm", "jitter / mm", "ms per scan",
          "spread across planes / cm", "map entropy"]
publish(options, [("real", "Real drives", header, [row for drive in drives.values() for row in rows_of([drive])]),
                  ("twins", "Their simulated twins, seed by seed", header,
                   [row for same in twins.values() for row in rows_of(same)]),
                  ("real_to_twin", "Errors, real to the median of the twins",
                   ["drive", "method", "figure", "real", "twins", "ratio", f"within {ALIKE}"],
                   [row for name in twins for row in compared(name)])])
PYTHON
