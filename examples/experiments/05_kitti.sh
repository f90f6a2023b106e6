#!/usr/bin/env bash
# KITTI's odometry benchmark: all sequences of a folder, in the form of the paper's table.
#
#   bash examples/experiments/05_kitti.sh KITTI_DIR [--quick] [--output DIR] [--vertical-correction DEGREES]
#
# KITTI_DIR is laid out as KITTI's archives are: sequences/00/velodyne/*.bin, sequences/00/calib.txt and times.txt,
# poses/00.txt. Its scans are compensated already: the odometry must not do it again.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *


def arguments(parser):
    parser.add_argument("kitti", type=pathlib.Path, metavar="KITTI_DIR", nargs="?")
    parser.add_argument("--vertical-correction", default="0.205", help="degrees; of KITTI's HDL-64")


def sequence(root, number):
    name = "kitti-" + number
    if options.tables_only:
        return Dataset(name, None, None) if name in options.records.of_data("name") else None
    folder = next((f for f in (root / "sequences" / number, root / number) if (f / "velodyne").is_dir()), None)
    truth = root / "poses" / f"{number}.txt"
    truth = truth if truth.exists() or not folder else folder / "poses.txt"
    if not folder or not truth.exists():
        return None
    calibration = folder / "calib.txt"
    has_tr = calibration.exists() and any(line.startswith("Tr:") for line in open(calibration))
    if not has_tr:
        log(f"{number}: no calib.txt with a line Tr: the poses are taken as the lidar's")
    return Dataset(name, folder / "velodyne", truth, sensor="hdl64", calibration=calibration if has_tr else None,
                   odometry_options=["--compensation", "none", "--vertical-correction",
                                     options.arguments.vertical_correction])


options = Options("05_kitti", "KITTI's odometry benchmark, sequences 00 to 10", arguments)
if not options.arguments.kitti and not options.tables_only:
    sys.exit("KITTI_DIR is missing: the folder of sequences/ and poses/")
numbers = [f"{i:02d}" for i in range(11)]
data = {n: s for n in numbers if (s := sequence(options.arguments.kitti, n))}
if not data:
    sys.exit(f"{options.arguments.kitti or options.output}: no sequences/00 to 10 with velodyne and poses")
runs = execute(options, [Run(d, "defaults") for d in (list(data.values())[:1] if options.quick else data.values())],
               timed=True)
rows, judged = [], []
for name, run in zip(data, runs):
    f = run.figures
    # KITTI's unit of rotation is degrees a metre.
    rows.append([name, number(f["path"], 0), number(f["t_rel"], 3), number(f["r_rel"], 5, 0.01), number(f["ate"], 2),
                 number(f["ms"], 1)])
    judged += [f] if f["t_rel"] is not None else []
    run.copy_picture(options.output / f"kitti_{name}.png")
    if f.get("standard") is False:
        log(f"{name}: too short for KITTI's lengths of 100 to 800 m; shorter ones were taken")
mean = lambda key: statistics.fmean(f[key] for f in judged) if judged else None
rows.append(["**mean**", "", number(mean("t_rel"), 3), number(mean("r_rel"), 5, 0.01), "", number(mean("ms"), 1)])
rows.append(["the paper's F-LOAM", "", "0.80", "0.0048", "", ""])
publish(options, [("kitti", "KITTI odometry", ["sequence", "path / m", "t_rel / %", "r_rel / °/m", "ATE / m",
                                              "ms per scan"], rows)])
bar_chart(options, "kitti", "KITTI odometry", "t_rel / %", list(data)[:len(runs)],
          [("t_rel", [run.figures["t_rel"] for run in runs])])
PYTHON
