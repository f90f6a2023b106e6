#!/usr/bin/env bash
# The paper's Table I: what the compensation of the sweep's distortion costs and gains. All modes that the tool knows.
#
#   bash examples/experiments/03_ablation.sh [--quick] [--data DIR] [--output DIR]
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *

DEFAULT = ", default"


def known_modes(options):
    if options.tables_only:
        return options.records.labels()
    default = default_compensation(options)
    return [mode + DEFAULT if mode == default else mode for mode in compensation_modes(options)]


options = Options("03_ablation", "modes of motion compensation: accuracy and time")
worlds = [("warehouse", "vlp16"), ("urban", "hdl64"), ("handheld", "vlp16")]
count = {"warehouse": 120, "urban": 40, "handheld": 100} if options.quick else {}
seed = 21
data = simulate(options, [(world, sensor, seed, count.get(world, 0), []) for world, sensor in worlds])
names = {"none": "none", "loam": "iterative (LOAM)", "two-stage": "two-stage (paper)"}
order = {mode: i for i, mode in enumerate(names)}
modes = sorted(known_modes(options), key=lambda mode: order.get(mode.removesuffix(DEFAULT), len(order)))
runs = {mode: execute(options, [Run(d, mode, ["--compensation", mode.removesuffix(DEFAULT)]) for d in data], timed=True)
        for mode in modes}

header = ["compensation"]
for world, _ in worlds:
    header += [f"{world}: ATE / cm", "t_rel / %", "ms per scan"]
rows = []
for mode in modes:
    row = [names.get(mode, mode)]
    for run in runs[mode]:
        row += [number(run.figures["ate"], 2, 100), number(run.figures["t_rel"], 3), number(run.figures["ms"], 1)]
    rows.append(row)
paper = [["none", "66.33", "2.132"], ["iterative (LOAM)", "84.52", "2.052"], ["two-stage", "69.07", "2.037"]]
publish(options, [("ablation", "Motion compensation (the paper's Table I)", header, rows),
                  ("ablation_paper", "The paper's own figures, on its warehouse robot with a VLP-16",
                   ["compensation", "ms per scan", "accuracy / cm"], paper)])
labels = [world for world, _ in worlds]
bar_chart(options, "ablation_accuracy", "Absolute trajectory error", "cm", labels,
          [(mode, [100 * run.figures["ate"] if run.figures["ate"] is not None else None for run in runs[mode]])
           for mode in modes], logarithmic=True)
bar_chart(options, "ablation_time", "Time per scan", "ms", labels,
          [(mode, [run.figures["ms"] for run in runs[mode]]) for mode in modes])
PYTHON
