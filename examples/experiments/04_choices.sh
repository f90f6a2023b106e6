#!/usr/bin/env bash
# What the paper leaves open or prints differently from what it says, each reading on real and simulated scans: of the
# family `tune`, as these are choices.
#
#   bash examples/experiments/04_choices.sh [--quick] [--data DIR] [--output DIR]
#
# KITTI's scans are used as well if ../shared/data/kitti_raw_0001 or $PCL_FLOAM_DATA/kitti_raw_0001 is there.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *

options = Options("04_choices", "readings of the paper, one row a choice")
plans = [("warehouse", "vlp16", 11, 600, []), ("handheld", "vlp16", 12, 300, []), ("urban", "hdl32", 13, 200, []),
         ("corridor", "vlp16", 14, 600, [])]
if options.quick:
    plans = [("warehouse", "vlp16", 11, 60, []), ("handheld", "vlp16", 12, 60, [])]
data = simulate(options, plans, family="tune")
names = [f"{world} {sensor}" for world, sensor, *_ in plans]
real = real_data("kitti_raw_0001")
with_real = "kitti-0001" in options.records.of_data("name") if options.tables_only else real.is_dir()
if with_real and not options.quick:
    data.insert(0, Dataset("kitti-0001", real / "velodyne", real / "poses.txt", sensor="hdl64",
                           odometry_options=["--vertical-correction", "0.205"]))
    names.insert(0, "KITTI raw 0001")

choices = [
    ("defaults", []),
    ("Eq. 1 as printed (mean of norms)", ["--smoothness", "mean-of-norms", "--edge-threshold", "0.3",
                                          "--plane-threshold", "0.3"]),
    ("Eq. 9 weights as printed, each kind's sum 1", ["--weights", "printed"]),
    ("Eq. 9 weights inverted", ["--weights", "inverted"]),
    ("solver: Ceres", ["--solver", "ceres"]),
    ("search: FLANN KD-tree", ["--search", "kdtree"]),
    ("kernel: none", ["--kernel", "none"]),
    ("kernel: Huber", ["--kernel", "huber"]),
    ("kernel: Geman-McClure", ["--kernel", "geman-mcclure"]),
    ("no edges", ["--edges-per-sector", "0"]),
    ("every scan a keyframe", ["--keyframe-translation", "0"]),
]
# The default is LOAM's by features.
choices += [(f"compensation: {mode}", ["--compensation", mode]) for mode in ("none", "two-stage")]

TIMED = ["defaults", "search: FLANN KD-tree", "every scan a keyframe", "solver: Ceres"]
runs = {}
for timed in (True, False):
    chosen = [(label, ["--engine", "features"] + arguments) for label, arguments in choices if (label in TIMED) == timed]
    all_runs = execute(options, [Run(d, label, arguments) for label, arguments in chosen for d in data], timed=timed)
    for i, (label, _) in enumerate(chosen):
        runs[label] = all_runs[i * len(data):(i + 1) * len(data)]

accuracy = [[label] + [number(run.figures["ate"], 2, 100) for run in runs[label]] for label, _ in choices]
times = [[label] + [number(run.figures["ms"], 1) for run in runs[label]] for label in TIMED]
publish(options, [("choices", "Absolute trajectory error / cm", [""] + names, accuracy),
                  ("choices_time", "Time per scan / ms, run alone", [""] + names, times)])
bar_chart(options, "choices", "Absolute trajectory error", "cm", [label for label, _ in choices],
          [(name, [100 * runs[label][i].figures["ate"] if runs[label][i].figures["ate"] is not None else None
                   for label, _ in choices]) for i, name in enumerate(names)], logarithmic=True)
PYTHON
