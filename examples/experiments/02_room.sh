#!/usr/bin/env bash
# A room as large as the paper's motion-capture one: the mean localisation error. The paper has 2 cm.
#
#   bash examples/experiments/02_room.sh [--quick] [--data DIR] [--output DIR]
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *

options = Options("02_room", "mean localisation error in a room")
seeds = [21] if options.quick else [21, 22, 23]
data = simulate(options, [("room", "vlp16", seed, 100 if options.quick else 0, []) for seed in seeds])
runs = execute(options, [Run(d, "defaults") for d in data], timed=True)
rows = [["paper, motion capture", "", "2", "", ""]]
for seed, run in zip(seeds, runs):
    f = run.figures
    rows.append([f"simulated, seed {seed}", number(f["path"], 0), number(f["mean_error"], 2, 100),
                 number(f["ate"], 2, 100), number(f["ms"], 1)])
    run.copy_picture(options.output / f"room_seed{seed}.png")
publish(options, [("room", "Room, VLP-16", ["", "path / m", "mean error / cm", "ATE rms / cm", "ms per scan"], rows)])
PYTHON
