#!/usr/bin/env bash
# Starts in traffic: the sensor wakes at 25 m/s among cars of the same speed, or stands beside the road while they pass.
# A start is lost if the motion from scan to scan is still off by more than 0.2 m at the end of 18 scans, or of as many
# as are asked for, and silent if the last of them is called tracked all the same, and not provisional.
#
#   bash examples/experiments/08_starts.sh [--quick] [--data DIR] [--output DIR] [--sensors NAME,NAME...] [--scans N]
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *
from detector import call, motion

LOST = 0.2  # m a scan
# name: seeds, seconds into the drive, options of the simulator
STARTS = {"moving at 25 m/s": ([31, 32, 33, 34, 35, 36], [0, 8, 16, 24, 32], []),
          "the same, other seeds": ([41, 42, 43, 44, 45, 46], [3, 12, 21, 30], []),
          "standing beside the road": ([51, 52, 53, 54, 55, 56], [0, 5, 10, 15], ["--standing", "-4"])}


def motions(rows):
    return [motion(before, after) for before, after in zip(rows, rows[1:])]


def judge(run):
    if not (run.folder / "poses.kitti.txt").exists():
        return {"lost": True, "silent": False}
    estimate, truth = (motions(positions(file)[0]) for file in (run.folder / "poses.kitti.txt", run.data.truth))
    if len(estimate) != len(truth):
        return {"lost": True, "silent": False}
    off = statistics.median(math.dist(e, t) for e, t in zip(estimate[-5:], truth[-5:]))
    last = list(csv.DictReader((run.folder / "scans.csv").read_text().splitlines()))[-1]
    is_good = call(last["state"], last["provisional"] == "1") == "good"
    return {"off_at_the_end": off, "lost": off > LOST, "silent": off > LOST and is_good}


def add_options(parser):
    parser.add_argument("--sensors", default="vlp16,hdl32")
    parser.add_argument("--scans", type=int, default=18)


options = Options("08_starts", "starts in traffic", add_options)
scans = options.arguments.scans
table = []
for name, (seeds, times, extra) in STARTS.items():
    for sensor in options.arguments.sensors.split(","):
        cases = [(seed, time) for seed in seeds for time in times][:2 if options.quick else None]
        data = simulate(options, [("highway", sensor, seed, scans, ["--start", time] + extra) for seed, time in cases])
        runs = execute(options, [Run(d, "defaults", judge=judge) for d in data])
        lost = [f"seed {seed} at {time} s" for (seed, time), run in zip(cases, runs) if run.figures["lost"]]
        silent = sum(bool(run.figures["silent"]) for run in runs)
        table.append([name, sensor, sum(run.is_recorded for run in runs), len(lost), silent, ", ".join(lost)])
COLUMNS = ["start", "sensor", "starts", "lost", "of these silent", "lost are"]
publish(options, [("starts", f"Starts on a highway, {scans} scans each", COLUMNS, table)])
PYTHON
