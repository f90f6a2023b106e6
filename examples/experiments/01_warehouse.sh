#!/usr/bin/env bash
# The paper's simulated warehouse (VLP-16, moving workers, up to 2 m/s): the trajectory against the true one.
#
#   bash examples/experiments/01_warehouse.sh [--quick] [--data DIR] [--output DIR]
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *

options = Options("01_warehouse", "trajectory in the warehouse against ground truth")
seeds = [21] if options.quick else [21, 22, 23]
data = simulate(options, [("warehouse", "vlp16", seed, 150 if options.quick else 0, []) for seed in seeds])
runs = execute(options, [Run(d, "defaults") for d in data], timed=True)
rows = []
for seed, run in zip(seeds, runs):
    f = run.figures
    rows.append([seed, number(f["path"], 0), number(f["ate"], 2, 100), number(f["mean_error"], 2, 100),
                 number(f["t_rel"], 3), number(f["r_rel"], 3), number(f["ms"], 1)])
    run.copy_picture(options.output / f"warehouse_seed{seed}.png")
publish(options, [("warehouse", "Warehouse, VLP-16", ["seed", "path / m", "ATE rms / cm", "mean error / cm", "t_rel / %",
                                                     "r_rel / °/100 m", "ms per scan"], rows)])
PYTHON
