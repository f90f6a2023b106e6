#!/usr/bin/env bash
# Is 'tracked' a promise? Roads, starts at speed, indoors, weather, gaps and blind sides, with the errors of real lasers:
# how many scans whose motion is wrong are not called good, and how many right ones are doubted.
#
#   bash examples/experiments/09_detector.sh [--quick] [--data DIR] [--output DIR] [--instant end|middle] [--family tune]
#                                            [--engine features]
#
# A scan is called good if its state is tracked or initialized and it is not provisional; called lost if it is predicted
# or not started; else doubtful. It is wrong if its motion since the anchor is off by more than 0.5 m + 1 % of the true
# way since the anchor. The anchor is the last scan before it that was right, or that was not called good: the user was
# told. It is right if it is so since either, since after a gap a pose may be found again, or go on from where it is; for
# the former the last right scan that was called good counts, as predictions may creep away.
#   So less than half a metre a scan is never wrong. Scans are slipping if none in the last second was wrong, all were
# called good, and the motion over that second is off by more than 0.5 m + 1 % all the same.
#   Poses are those of the file, as corrected later; what was said of a scan is what was said when it came.
#   Asked: of wrong scans at least 99 % not called good; of right ones at most 0.5 % called lost; of all motions from
# scan to scan, lost runs included, 99 % within three sigma of both scans' position covariances, along the error.
# A scan without returns, as in a gap, is rightly called lost: the last figure but one leaves those out.
#   --instant middle takes the poses at the middle of the sweep, for which the covariance is meant.
#   Worlds are of the family `report`, seeds 901 and up: no setting was chosen on them. --family tune takes the same
# list of the family, and of seeds, that settings may be chosen on. The motorway along KITTI's path
# 01 needs ../shared/data/kitti_odom_paths/01.txt, or $PCL_FLOAM_DATA/kitti_odom_paths/01.txt.
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$(dirname "$0")" exec python3 /dev/fd/3 "$@" 3<<'PYTHON'
from support import *
from detector import characteristic, judge_run, share

PATH = real_data("kitti_odom_paths/01.txt")
ALONG = ["--trajectory", PATH]
# group: world, sensor, seeds, scans, options; options by seed where these differ
GROUPS = {
    "open road, from rest": [("open-road", "vlp16", [901, 902, 903], 150, []),
                             ("open-road", "hdl32", [904, 905], 120, [])],
    "open road, at speed": [("open-road", "vlp16", [911, 912, 913], 100, ["--begin", "speed"]),
                            ("open-road", "hdl32", [914, 915], 100, ["--begin", "speed"])],
    "motorway, KITTI 01": [("motorway", "vlp16", [920 + i], 60, ALONG + ["--from", start])
                           for i, start in enumerate([130, 230, 330, 430, 530, 730])]
                          + [("motorway", "hdl64", [926 + i], 60, ALONG + ["--from", start])
                             for i, start in enumerate([230, 530])],
    "highway": [("highway", "vlp16", [931, 932], 80, ["--start", 5]),
                ("highway", "hdl32", [933, 934], 80, ["--start", 5]),
                ("highway", "hdl64", [935], 60, ["--start", 5])],
    "town": [("town", "hdl64", [941], 80, []), ("town", "hdl32", [942], 80, []), ("town", "vlp16", [943], 100, [])],
    "urban": [("urban", "hdl32", [944], 80, []), ("urban", "vlp16", [945], 100, [])],
    "warehouse": [("warehouse", "vlp16", [951, 952], 150, [])],
    "room": [("room", "vlp16", [953, 954], 150, [])],
    "handheld": [("handheld", "vlp16", [955, 956, 957], 150, [])],
    "corridor": [("corridor", "vlp16", [958, 959, 960], 150, []), ("corridor", "hdl32", [946], 100, []),
                 ("corridor", "os64", [947, 948, 949], 100, []), ("corridor", "mid360", [967, 968], 100, [])],
    "tunnel": [("tunnel", "vlp16", [961, 962, 963], 150, [])],
    "car park": [("car-park", "mid360", [964, 965, 966], 100, [])],
    "rain, snow, dust": [("open-road", "vlp16", [971], 100, ["--rain", 25]), ("town", "hdl32", [972], 80, ["--snow", 2]),
                         ("warehouse", "vlp16", [973], 100, ["--dust", 0.1]),
                         ("open-road", "vlp16", [974], 100, ["--dust", 0.05, "--begin", "speed"])],
    "one beam in twenty tells any range": [("warehouse", "vlp16", [991], 100, ["--stray", 0.05]),
                                           ("corridor", "vlp16", [992], 100, ["--stray", 0.05]),
                                           ("urban", "vlp16", [993], 100, ["--stray", 0.05]),
                                           ("handheld", "vlp16", [994], 100, ["--stray", 0.05]),
                                           ("open-road", "vlp16", [995], 100, ["--stray", 0.05, "--begin", "speed"]),
                                           ("town", "hdl32", [996], 80, ["--stray", 0.05])],
    "corridor, looking down by 45°": [("corridor", "vlp16", [997, 998], 100, ["--mount", 0, 45, 0]),
                                      ("corridor", "hdl32", [999], 100, ["--mount", 0, 45, 0]),
                                      ("corridor", "os64", [1000], 100, ["--mount", 0, 45, 0])],
    "a second without returns": [("warehouse", "vlp16", [975], 100, ["--gap", "5:6"]),
                                 ("open-road", "vlp16", [976], 100, ["--gap", "6:7"]),
                                 ("town", "hdl32", [977], 100, ["--gap", "5:6"])],
    "120° of view": [("warehouse", "vlp16", [981], 100, ["--field-of-view", 120]),
                     ("town", "hdl32", [982], 80, ["--field-of-view", 120]),
                     ("open-road", "vlp16", [983], 100, ["--field-of-view", 120])],
    "a lorry beside": [("highway", "vlp16", [985], 80, ["--truck"]), ("highway", "hdl32", [986], 80, ["--truck"]),
                       ("open-road", "vlp16", [987], 100, ["--truck", "--begin", "speed"])],
}
QUICK = {"open road, at speed": 1, "room": 1, "a second without returns": 1}  # groups, and how many rows of each
QUICK_SCANS = 70
TUNE_BELOW = 300  # by so much less are the seeds of the family `tune`


def arguments(parser):
    parser.add_argument("--family", default="report", choices=["report", "tune"], help="of worlds")
    parser.add_argument("--engine", default="surfaces", choices=["surfaces", "features"], help="of the odometry")
    parser.add_argument("--instant", default="end", choices=["end", "middle"], help="of the sweep: which pose is judged")


def plans():
    """(group, plan of the simulator) of all runs."""
    family = options.arguments.family
    for group, rows in GROUPS.items():
        for world, sensor, seeds, scans, extra in rows[:QUICK.get(group, 0) if options.quick else None]:
            if ALONG[0] in extra and not (PATH.exists() or options.tables_only):
                log(f"{group}, {sensor}, from {extra[-1]} m: skipped, {PATH} is not there")
                continue
            for seed in seeds[:1 if options.quick else None]:
                count = min(scans, QUICK_SCANS) if options.quick else scans
                yield group, (world, sensor, seed - TUNE_BELOW * (family == "tune"), count,
                              extra + ["--family", family, "--realism", "real"])


def total(runs, key):
    return sum(run.figures[key] for run in runs)


def counted(part, whole):
    return f"{part} of {whole}" + (f", {share(part, whole):.1f} %" if whole else "")


def row(name, sensor, runs):
    """Counts over runs of a kind."""
    right = total(runs, "judged") - total(runs, "wrong")
    drift = [run.figures["t_rel"] for run in runs if run.figures["t_rel"] is not None]
    return [name, sensor, len(runs), total(runs, "judged"), total(runs, "slipping"), total(runs, "wrong"),
            counted(total(runs, "found"), total(runs, "wrong")), number(share(total(runs, "right_doubted"), right), 2),
            number(share(total(runs, "right_lost"), right), 2),
            number(share(total(runs, "within"), total(runs, "judged")), 1),
            " ".join(number(value, 2) for value in sorted(drift))]


def verdict(name, value, asked, is_least):
    held = "–" if value is None else "yes" if (value >= asked if is_least else value <= asked) else "**no**"
    return [name, number(value, 2), ("at least " if is_least else "at most ") + str(asked), held]


def draw_characteristic(runs):
    explained, told = ([[sign * value for run in runs for value in run.figures[f"{figure}_of_{which}"] or []]
                        for which in ("wrong", "right")] for figure, sign in (("explained", 1.0), ("told", -1.0)))
    right = total(runs, "judged") - total(runs, "wrong")
    said = (share(total(runs, "right_doubted") + total(runs, "right_lost"), right),
            share(total(runs, "found"), total(runs, "wrong")))
    if not all(explained):
        log("no picture: nothing was wrong, or nothing right")
        return
    curves(options, "detector", "Wrong scans found against right scans doubted",
           ("right scans not called good / %", "wrong scans not called good / %"),
           [("doubted where the map explains less than a threshold", characteristic(*explained)),
            ("doubted where a scan tells its position worse than to a threshold", characteristic(*told))],
           [("as the library calls them", [said])])


options = Options("09_detector", "whether 'tracked' is a promise", arguments)
groups, all_plans = zip(*plans())
data = simulate(options, all_plans)
for d in data:
    if options.arguments.instant == "middle" or "--field-of-view" in d.description["options"]:
        d.judge_at_the_middle()
engine, label = options.arguments.engine, options.arguments.instant
extra, label = ([], label) if engine == "surfaces" else (["--engine", engine], f"{label}-{engine}")
runs = execute(options, [Run(d, label, extra, judge=judge_run) for d in data])
kinds = collections.defaultdict(list)
for group, run in zip(groups, runs):
    if run.figures["judged"] is not None:
        kinds[group, run.data.description["sensor"]].append(run)
    elif run.is_recorded:
        log(f"{run.name}: no result")
good = [run for members in kinds.values() for run in members]
if not good:
    sys.exit("no runs")
lost, unseen = total(good, "right_lost"), total(good, "right_unseen")
right = total(good, "judged") - total(good, "wrong")
summary = [verdict("wrong scans not called good / %", share(total(good, "found"), total(good, "wrong")), 99, True),
           verdict("right scans called lost / %", share(lost, right), 0.5, False),
           verdict("the same without scans of too few points / %", share(lost - unseen, right - unseen), 0.5, False),
           verdict("motions within three sigma / %", share(total(good, "within"), total(good, "judged")), 99, True)]
everything = row("**all**", "", good)[:-1] + [""]
header = ["where", "sensor", "runs", "scans", "slipping", "wrong", "of these not called good", "right: doubted / %",
          "right: lost / %", "within 3 sigma / %", "t_rel of each run / %"]
publish(options, [("detector", "What is said of scans, and what they are", header,
                   [row(name, sensor, members) for (name, sensor), members in kinds.items()] + [everything]),
                  ("detector_asked", "What is asked", ["figure", "found", "asked", "held"], summary)])
draw_characteristic(good)
PYTHON
