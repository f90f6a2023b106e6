#!/usr/bin/env bash
# The README's accuracy table: defaults, real drives first, then worlds of the family `report`, three seeds each.
#
#   bash examples/experiments/11_accuracy.sh [--quick] [--data DIR] [--output DIR]
#
# Real drives are taken of ../shared/data or $PCL_FLOAM_DATA, as far as they are there: kitti_raw_0001 and
# kitti_odom_01_ramp, each with velodyne and poses.txt.
# Doubtful is the share of scans, of all seeds, that the odometry does not call tracked.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *

SEEDS = [1, 2, 3]
RAISED = ["--vertical-correction", "0.205"]
# name, folder, options
DRIVES = [("KITTI raw 2011_09_26_drive_0001, HDL-64, real", "kitti_raw_0001", RAISED + ["--pose-instant", "middle"]),
          ("KITTI odometry 01, a motorway ramp, HDL-64, real", "kitti_odom_01_ramp", RAISED)]
# name, world, sensor, scans, options of the simulator
WORLDS = [("open road from rest, VLP-16", "open-road", "vlp16", 150, []),
          ("the same at 25 m/s", "open-road", "vlp16", 150, ["--begin", "speed"]),
          ("open road from rest, errors of a real VLP-16", "open-road", "vlp16", 150, ["--realism", "real"]),
          ("motorway with banks, HDL-64", "highway", "hdl64", 100, []),
          ("city, HDL-64", "urban", "hdl64", 100, []),
          ("city, errors of a real HDL-64", "urban", "hdl64", 100, ["--realism", "real"]),
          ("warehouse, VLP-16", "warehouse", "vlp16", 150, []),
          ("warehouse, errors of a real VLP-16", "warehouse", "vlp16", 150, ["--realism", "real"]),
          ("room, VLP-16", "room", "vlp16", 150, []),
          ("held by hand, to 120°/s, VLP-16", "handheld", "vlp16", 150, []),
          ("corridor with doors, VLP-16", "corridor", "vlp16", 150, []),
          ("car park, Livox Mid-360", "car-park", "mid360", 80, [])]
QUICK = ["room"]
QUICK_SCANS = 40


def real_runs():
    for name, folder, extra in DRIVES:
        scans = real_data(folder) / "velodyne"
        if options.tables_only or scans.exists():
            data = Dataset(folder, scans, real_data(folder) / "poses.txt", odometry_options=extra, world="real",
                           sensor="hdl64", options=extra)
            yield name, "pcl_floam_odometry velodyne " + " ".join(extra), execute(options, [Run(data, "default", judge=doubted)])
        else:
            log(f"{name}: skipped, {scans} is not there")


def simulated_runs():
    for name, world, sensor, scans, extra in WORLDS:
        count = min(scans, QUICK_SCANS) if options.quick else scans
        extra = extra + ["--family", "report"]
        seeds = SEEDS[:1 if options.quick else None]
        data = simulate(options, [(world, sensor, seed, count, extra) for seed in seeds], realism=None)
        command = f"pcl_floam_simulate {world} --sensor {sensor} --scans {count} " + " ".join(extra)
        yield name, command, execute(options, [Run(d, "default", judge=doubted) for d in data])


def row(name, command, runs):
    scans = sum(run.figures["scans"] or 0 for run in runs)
    share = 100.0 * sum(run.figures["doubted"] or 0 for run in runs) / scans if scans else None
    listed = lambda key, digits, factor=1.0: " ".join(number(run.figures[key], digits, factor) for run in runs)
    return [name, f"`{command}`", listed("t_rel", 2), listed("ate", 1, 100.0), number(share, 0)]


options = Options("11_accuracy", "the README's accuracy table")
if options.quick:
    WORLDS = [world for world in WORLDS if world[1] in QUICK]
rows = [row(*group) for runs in (real_runs(), simulated_runs()) for group in runs]
publish(options, [("accuracy", "Accuracy", ["scans", "command", "t_rel / %", "ATE (rms) / cm", "doubtful / %"], rows)])
PYTHON
