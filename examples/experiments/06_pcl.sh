#!/usr/bin/env bash
# Against PCL itself: ICP, point-to-plane ICP, GICP and NDT as scan-to-scan odometry on the same scans.
#
#   bash examples/experiments/06_pcl.sh [--quick] [--data DIR] [--output DIR]
#
# PCL's methods get what a user of PCL would give them: scans thinned by pcl::VoxelGrid (0.25 m indoors, 0.5 m
# outdoors), a constant-velocity guess, correspondences up to 1 m, NDT cells of 1 m indoors and 2 m outdoors.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *

options = Options("06_pcl", "PCL's registrations as odometry, beside pcl_floam")
worlds = [("warehouse", "vlp16", 600, 40), ("room", "vlp16", 600, 40), ("urban", "hdl32", 300, 20)]
data = simulate(options, [(world, sensor, 21, quick if options.quick else full, [])
                          for world, sensor, full, quick in worlds])
OUTDOORS = {"urban": ["--leaf", "0.5", "--resolution", "2.0"]}
methods = [("ICP", "icp"), ("ICP, point to plane", "icp-plane"), ("GICP", "gicp"), ("NDT", "ndt"), ("pcl_floam", None)]
runs = {label: execute(options, [Run(d, method or "defaults", OUTDOORS.get(world[0], []) if method else [], method)
                                 for d, world in zip(data, worlds)], timed=True) for label, method in methods}
header = [""]
for world, sensor, *_ in worlds:
    header += [f"{world} {sensor}: ATE / m", "t_rel / %", "ms per scan"]
rows = []
for label, _ in methods:
    row = [label]
    for run in runs[label]:
        row += [number(run.figures["ate"], 3), number(run.figures["t_rel"], 3), number(run.figures["ms"], 1)]
    rows.append(row)
publish(options, [("pcl", "Odometry with PCL's registrations and with pcl_floam, on the same scans", header, rows)])
labels = [world for world, *_ in worlds]
for key, title, unit in (("ate", "Absolute trajectory error", "m"), ("ms", "Time per scan", "ms")):
    bar_chart(options, "pcl_" + key, title, unit, labels,
              [(label, [run.figures[key] for run in runs[label]]) for label, _ in methods], logarithmic=True)
PYTHON
