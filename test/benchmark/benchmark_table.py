#!/usr/bin/env python3
"""Turns the JSON of stage_benchmarks into Markdown tables: benchmark_table.py benchmark.json benchmark.md

With gnuplot installed, draws how the cost grows, beside the second file.
"""
import json
import math
import subprocess
import sys


def grouped(benchmarks, kind):
    """{group: {name: entry}} of the benchmarks called kind/group/name."""
    groups = {}
    for entry in benchmarks:
        parts = entry["name"].split("/")
        if parts[0] == kind:
            groups.setdefault(parts[1], {})[parts[2]] = entry
    return groups


def milliseconds(entry):
    return entry["cpu_time"]


MOST_SPREAD = 0.1  # of the reference, between its repeats


def ratio(run):
    if run["reference_spread"] > MOST_SPREAD:
        return "not told: the reference varied by {:.0f} %".format(100.0 * run["reference_spread"])
    return "**{:.2f}**".format(run["ratio"])


def pipeline_table(benchmarks):
    """Times of scans; those beyond the median in medians."""
    lines = ["| sequence | threads | median | reference | median / reference | 95 % | 99 % | 99.9 % | slowest |",
             "|---|---|---|---|---|---|---|---|---|"]
    for group, runs in grouped(benchmarks, "pipeline").items():
        for name, run in runs.items():
            lines.append("| {} | {} | {:.2f} ms | {:.2f} ms | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} ({}) |".format(
                group, name.split()[0], run["median_ms"], run["reference_ms"], ratio(run), run["p95_medians"],
                run["p99_medians"], run["p999_medians"], run["slowest_medians"], run["label"]))
    return lines


def load_line(context):
    loads = ", ".join("{:.2f}".format(load) for load in context.get("load_avg", []))
    return "{} processors; load before (1, 5, 15 minutes): {}".format(context["num_cpus"], loads or "not known")


def stage_table(benchmarks):
    groups = grouped(benchmarks, "stage")
    names = list(dict.fromkeys(name for stages in groups.values() for name in stages))
    lines = ["| ms | " + " | ".join(groups) + " |", "|---" * (len(groups) + 1) + "|"]
    for name in names:
        cells = ["{:.3f}".format(milliseconds(stages[name])) if name in stages else "" for stages in groups.values()]
        lines.append("| " + name + " | " + " | ".join(cells) + " |")
    return lines


def exponent(points):
    """Slope of the straight line through the logarithms."""
    xs = [math.log(x) for x, _ in points]
    ys = [math.log(y) for _, y in points]
    mean_x, mean_y = sum(xs) / len(xs), sum(ys) / len(ys)
    spread = sum((x - mean_x) ** 2 for x in xs)
    return sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / spread if spread > 0 else float("nan")


def growth(benchmarks):
    return {group: [(int(name), milliseconds(run)) for name, run in runs.items()]
            for group, runs in grouped(benchmarks, "growth").items()}


def growth_table(curves):
    lines = ["| cost of | measured (size: ms) | fitted exponent |", "|---|---|---|"]
    for name, points in curves.items():
        measured = ", ".join("{:,}: {:.2f}".format(size, ms) for size, ms in points)
        lines.append("| {} | {} | {:.2f} |".format(name, measured, exponent(points)))
    return lines


def plot_growth(curves, picture):
    script = ["set terminal svg size 720,420", "set output '{}'".format(picture), "set logscale xy", "set key left top",
              "set xlabel 'size'", "set ylabel 'ms'", "set grid"]
    plots = []
    for i, (name, points) in enumerate(curves.items()):
        script += ["$d{} << EOD".format(i)] + ["{} {}".format(*p) for p in points] + ["EOD"]
        plots.append("$d{} with linespoints lw 2 title '{}'".format(i, name))
    script.append("plot " + ", ".join(plots))
    try:
        subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        print("no picture: {}".format(error), file=sys.stderr)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1]) as file:
        record = json.load(file)
    benchmarks = record["benchmarks"]
    curves = growth(benchmarks)
    lines = [load_line(record["context"]), ""] + pipeline_table(benchmarks) + [""] + stage_table(benchmarks) + [""] + growth_table(curves)
    with open(sys.argv[2], "w") as file:
        file.write("\n".join(lines) + "\n")
    print("\n".join(lines))
    if curves:
        plot_growth(curves, sys.argv[2].rsplit(".", 1)[0] + "_growth.svg")


if __name__ == "__main__":
    main()
