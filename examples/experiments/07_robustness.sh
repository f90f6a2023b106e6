#!/usr/bin/env bash
# Every world, three seeds, defaults only; again with returns missing, with noise and on other sensors; GICP and NDT
# odometry of PCL beside it.
#
#   bash examples/experiments/07_robustness.sh [--quick] [--data DIR] [--output DIR]
#                                              [--subset WORLD,WORLD...] [--variants NAME,NAME...] [--seeds N,N,N]
#
# In full this simulates and runs for hours and takes tens of gigabytes; --subset and --variants take a part of it, and
# what was made once is used again.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *

# world: usual sensor, figure, its target (m or %), quick scans
WORLDS = {"warehouse": ("vlp16", "ate", 0.015, 60), "room": ("vlp16", "ate", 0.01, 60),
          "urban": ("hdl64", "t_rel", 0.03, 20), "highway": ("hdl64", "t_rel", 0.10, 20),
          "corridor": ("vlp16", "ate", 0.10, 60), "handheld": ("vlp16", "ate", 0.015, 60),
          "tunnel": ("vlp16", "across", 0.02, 60)}
# variant: options of the simulator, sensor
VARIANTS = {"plain": ([], None), "dropout": (["--dropout", "0.3"], None), "noise": (["--range-noise", "0.05"], None),
            "vlp16": ([], "vlp16"), "hdl32": ([], "hdl32"), "hdl64": ([], "hdl64"), "os128": ([], "os128"),
            # Only when asked for by --variants:
            "half-blind": (["--field-of-view", "120"], None), "gap": (["--gap", "5:6"], None),
            "sparse": (["--dropout", "0.9"], None), "wide-beam": (["--beam-divergence", "3"], None),
            "truck": (["--truck"], None)}
USUAL = ["plain", "dropout", "noise", "vlp16", "hdl32", "hdl64", "os128"]
NAMES = {"plain": "usual sensor", "dropout": "30 % of returns missing", "noise": "5 cm range noise",
         "half-blind": "120° field of view", "gap": "a second without returns", "sparse": "90 % of returns missing",
         "wide-beam": "beam 3 mrad wide", "truck": "a lorry beside"}
UNIT = {"ate": ("ATE / cm", 100, 2), "across": ("across / cm", 100, 2), "t_rel": ("t_rel / %", 1, 3)}


def arguments(parser):
    parser.add_argument("--subset", default=",".join(WORLDS), help="worlds")
    parser.add_argument("--variants", default=",".join(USUAL), help="of the scans: " + ", ".join(VARIANTS))
    parser.add_argument("--seeds", default="21,22,23")
    parser.add_argument("--no-pcl", action="store_true", help="without GICP and NDT")


def across(run):
    """Greatest error across a tunnel along x, m, after the best rotation about y and z and shift across: the
    direction along it can't be known."""
    rows, estimate = positions(run.folder / "poses.kitti.txt")
    true_rows, truth = positions(run.data.truth_middle if run.method else run.data.truth)
    first = true_rows[0]
    moved = [[sum(first[4 * i + k] * p[k] for k in range(3)) + first[4 * i + 3] for i in range(3)] for p in estimate]
    worst = [0.0] * len(truth)
    for axis in (1, 2):
        xs = [t[0] for t in truth]
        errors = [m[axis] - t[axis] for m, t in zip(moved, truth)]
        mean_x, mean_e = statistics.fmean(xs), statistics.fmean(errors)
        spread = sum((x - mean_x) ** 2 for x in xs)
        slope = sum((x - mean_x) * (e - mean_e) for x, e in zip(xs, errors)) / spread if spread > 0 else 0.0
        worst = [w + (e - mean_e - slope * (x - mean_x)) ** 2 for w, e, x in zip(worst, errors, xs)]
    return math.sqrt(max(worst))


def judge(run):
    has_result = (run.folder / "poses.kitti.txt").exists() and run.data.description["world"] == "tunnel"
    return {"across": across(run)} if has_result else {}


def cell(runs, key):
    _, factor, digits = UNIT[key]
    return " ".join(number(run.figures[key], digits, factor) for run in runs)


options = Options("07_robustness", "all worlds, seeds, sensors; PCL's GICP and NDT beside", arguments)
worlds = options.arguments.subset.split(",")
variants = options.arguments.variants.split(",")
seeds = [int(s) for s in options.arguments.seeds.split(",")][:1 if options.quick else None]
if options.tables_only and options.records.all():
    seeds, variants = sorted(options.records.of_data("seed")), list(VARIANTS)
table, chart = [], {}
for world in worlds:
    usual, key, target, quick = WORLDS[world]
    for variant in variants:
        extra, sensor = VARIANTS[variant]
        if sensor == usual and "plain" in variants:
            continue
        data = simulate(options, [(world, sensor or usual, seed, quick if options.quick else 0, extra)
                                  for seed in seeds])
        if variant == "half-blind":
            for d in data:  # the last return is a third of a turn before the turn's end
                d.judge_at_the_middle()
        plans = [("pcl_floam", None)]
        plans += [("GICP", "gicp"), ("NDT", "ndt")] if variant == "plain" and not options.arguments.no_pcl else []
        coarse = ["--leaf", "0.5", "--resolution", "2.0"] if key == "t_rel" else []
        results = execute(options, [Run(d, label, coarse if method else [], method, judge)
                                    for label, method in plans for d in data])
        if options.tables_only and not any(run.is_recorded for run in results):
            continue
        parts = [results[i * len(data):(i + 1) * len(data)] for i in range(len(plans))]
        allowed = target * (1 if variant == "plain" else 2)
        found = [run.figures[key] for run in parts[0]]
        held = all(f is not None and f <= allowed for f in found)
        unit, factor, digits = UNIT[key]
        name = NAMES.get(variant, sensor)
        table.append([world, f"{name} ({usual})" if variant == "plain" else name, unit, cell(parts[0], key),
                      number(allowed, digits, factor), "yes" if held else "**no**"]
                     + ([cell(p, key) for p in parts[1:]] if len(parts) > 1 else ["", ""]))
        chart[(world, variant)] = max((f for f in found if f is not None), default=None)
publish(options, [("robustness", f"Defaults only, seeds {', '.join(map(str, seeds))}",
                   ["world", "scans", "figure", "pcl_floam, by seed", "at most", "held", "GICP", "NDT"], table)])
relative = lambda w, v: chart[(w, v)] / WORLDS[w][2] if chart.get((w, v)) is not None else None
bar_chart(options, "robustness", "Worst seed's error as a share of the plain target", "ratio", worlds,
          [(NAMES.get(v, v), [relative(w, v) for w in worlds]) for v in variants], logarithmic=True)
PYTHON
