#!/usr/bin/env bash
# The drives that choices look at: worlds of the family `tune`, with the errors of real lasers. With --against, another
# build's tools run over the same scans, and the figures are told as ratios to theirs.
#
#   bash examples/experiments/12_tune.sh [--quick] [--against BIN] [--data DIR] [--output DIR]
#
# Figures of these drives are no result, and published nowhere. The other build's runs are recorded under this tree's
# commit.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *

SEEDS = [651, 652, 653]
# name, world, sensor, scans, options of the simulator
WORLDS = [("city, HDL-64", "urban", "hdl64", 40, []),
          ("city, OS-128", "urban", "os128", 30, []),
          ("room, HDL-32", "room", "hdl32", 60, []),
          ("warehouse, VLP-16", "warehouse", "vlp16", 80, []),
          ("hand-held, VLP-16", "handheld", "vlp16", 80, []),
          ("corridor, VLP-16", "corridor", "vlp16", 80, []),
          ("open road, VLP-16", "open-road", "vlp16", 100, []),
          ("open road at speed, VLP-16", "open-road", "vlp16", 100, ["--begin", "speed"]),
          ("highway, VLP-16", "highway", "vlp16", 60, []),
          ("highway, HDL-64", "highway", "hdl64", 40, []),
          ("car park, Mid-360", "car-park", "mid360", 60, [])]
FIGURES = [("t_rel / %", "t_rel", 3, 1.0), ("ATE / cm", "ate", 2, 100.0), ("doubted", "doubted", 0, 1.0),
           ("ms", "ms", 2, 1.0), ("slowest / medians", "slowest", 1, 1.0)]


def told(run):
    """Scans that are not called tracked, and how many times the median the slowest takes."""
    file = run.folder / "timing.csv"
    times = [float(row["total_ms"]) for row in csv.DictReader(file.read_text().splitlines())] if file.exists() else []
    return {**doubted(run), **({"slowest": max(times) / statistics.median(times)} if times else {})}


def means(runs):
    """Of each figure; nothing where a run has none."""
    values = {key: [run.figures[key] for run in runs] for _, key, _, _ in FIGURES}
    return {key: statistics.mean(all_of) if None not in all_of else None for key, all_of in values.items()}


def cells(runs, others):
    own, other = means(runs), means(others) if others else None
    for _, key, digits, factor in FIGURES:
        cell = number(own[key], digits, factor)
        if other and own[key] is not None and other[key] is not None and own[key] != other[key]:
            cell += f" ({own[key] / other[key]:.2f})" if other[key] else " (0 there)"
        yield cell


def geometric_means(pairs):
    """Of the ratios of all drives, and the sums of what is counted."""
    for _, key, _, _ in FIGURES:
        both = [(a.figures[key], b.figures[key]) for a, b in pairs]
        if key == "doubted":
            yield f"{sum(a or 0 for a, _ in both)} ({sum(b or 0 for _, b in both)})"
        else:
            logs = [math.log(a / b) for a, b in both if a and b]
            yield f"({math.exp(statistics.mean(logs)):.3f})" if logs else ""


options = Options("12_tune", "the drives that choices look at",
                  lambda parser: parser.add_argument("--against", type=pathlib.Path, help="folder of another build's tools"))
if options.quick:
    WORLDS, SEEDS = WORLDS[:3], SEEDS[:1]
plans = [(world, sensor, seed, count, extra) for _, world, sensor, count, extra in WORLDS for seed in SEEDS]
data = simulate(options, plans, family="tune")
builds = [("this", options.arguments.bin)] + ([("other", options.arguments.against)] if options.arguments.against else [])
runs = {}
for label, folder in builds:
    options.arguments.bin = folder
    runs[label] = execute(options, [Run(d, label, judge=told) for d in data], timed=True)
each = len(SEEDS)
rows = [[name, *cells(*(runs[label][i * each:(i + 1) * each] if label in runs else [] for label in ("this", "other")))]
        for i, (name, *_) in enumerate(WORLDS)]
if "other" in runs:
    rows.append(["all", *geometric_means(list(zip(runs["this"], runs["other"])))])
publish(options, [("tune", "Drives that choices look at", ["drive", *(title for title, *_ in FIGURES)], rows)])
PYTHON
