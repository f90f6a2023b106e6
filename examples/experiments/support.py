"""What the experiments share: options, simulated data, runs, judgement, tables, pictures. Python's library only.

Simulated scans are kept in the data folder and made once. A result is kept as long as it is newer than its program,
so that an experiment that was stopped goes on where it was, and one whose program was rebuilt starts afresh.
"""

import argparse
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parents[2]


class Options:
    """The command line that all experiments have; further arguments by `add`, a function of the parser."""

    def __init__(self, name, description, add=None):
        cache = pathlib.Path(os.environ.get("TMPDIR", "/tmp")) / "pcl_floam_experiments"
        parser = argparse.ArgumentParser(prog=name + ".sh", description=description)
        parser.add_argument("--quick", action="store_true", help="short runs, to see that all works")
        parser.add_argument("--data", type=pathlib.Path, default=cache / "data", help="cache of simulated scans")
        parser.add_argument("--output", type=pathlib.Path, default=cache / name, help="tables, pictures, results")
        parser.add_argument("--bin", type=pathlib.Path, default=HERE / "build/demo/bin", help="folder of the tools")
        parser.add_argument("--jobs", type=int, default=2, help="runs at a time, where no time is measured")
        if add:
            add(parser)
        self.arguments = parser.parse_args()
        self.name = name
        self.quick = self.arguments.quick
        self.output = self.arguments.output
        self.output.mkdir(parents=True, exist_ok=True)
        self._require_tools()

    def _require_tools(self):
        wanted = ["pcl_floam_odometry", "pcl_floam_evaluate", "pcl_floam_simulate", "pcl_floam_pcl_odometry"]
        build = HERE / "build/demo"
        if self.arguments.bin == build / "bin" and not all((build / "bin" / tool).exists() for tool in wanted):
            log("building the tools in " + str(build))
            subprocess.run(["cmake", "-S", HERE, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DPCL_FLOAM_BUILD_TESTS=OFF"], check=True, stdout=subprocess.DEVNULL)
            subprocess.run(["cmake", "--build", build, "--target"] + wanted, check=True, stdout=sys.stderr)

    def tool(self, name):
        return self.arguments.bin / name


def log(text):
    print(text, file=sys.stderr, flush=True)


class Dataset:
    """Scans with true poses at the sweep's end and middle."""

    def __init__(self, name, scans, truth, truth_middle=None, odometry_options=(), calibration=None):
        self.name, self.scans, self.truth = name, scans, truth
        self.truth_middle = truth_middle or truth
        self.odometry_options = list(odometry_options)
        self.calibration = calibration


def simulate(options, plans):
    """Makes what is not there yet, several at a time. A plan: (world, sensor or None, seed, scans or 0, extra options).
    Returns the data sets in the plans' order."""

    def one(plan):
        world, sensor, seed, scans, extra = plan
        parts = [world, sensor or "usual", f"seed{seed}", f"{scans}scans" if scans else "all"]
        folder = options.arguments.data / "-".join(parts + [str(word).strip("-") for word in extra])
        if not (folder / "poses_end.txt").exists():
            folder.parent.mkdir(parents=True, exist_ok=True)
            making = pathlib.Path(tempfile.mkdtemp(dir=folder.parent, prefix="making-"))
            log("simulating " + folder.name)
            command = [options.tool("pcl_floam_simulate"), world, "--seed", str(seed), "--output", making]
            command += ["--sensor", sensor] if sensor else []
            command += ["--scans", str(scans)] if scans else []
            subprocess.run(command + [str(word) for word in extra], check=True, stderr=subprocess.DEVNULL)
            if folder.exists():
                shutil.rmtree(folder)
            making.rename(folder)
        return Dataset(folder.name, folder / "scans", folder / "poses_end.txt", folder / "poses_middle.txt")

    with concurrent.futures.ThreadPoolExecutor(options.arguments.jobs) as pool:
        return list(pool.map(one, plans))


class Run:
    """One program on one data set. `figures` has, after `execute`: ate and mean_error (m), t_rel (%), r_rel
    (degree/100 m), path (m), ms (median), exit status; all None but the status if there is no result."""

    def __init__(self, data, label, arguments=(), method=None):
        self.data, self.label, self.arguments, self.method = data, label, [str(a) for a in arguments], method
        self.figures = {}
        self.folder = None

    def _command(self, options):
        if self.method:
            command = [options.tool("pcl_floam_pcl_odometry"), "--method", self.method]
        else:
            command = [options.tool("pcl_floam_odometry"), "--quiet", "--plot", "png", "--ground-truth",
                       self.data.truth] + self.data.odometry_options
            command += ["--calibration", self.data.calibration] if self.data.calibration else []
        return [str(word) for word in command + [self.data.scans, "--output", self.folder] + self.arguments]

    def execute(self, options):
        name = "".join(c if c.isalnum() or c in ".-" else "_" for c in f"{self.data.name}-{self.label}")
        self.folder = options.output / "runs" / name
        self.folder.mkdir(parents=True, exist_ok=True)
        command = self._command(options)
        done = self.folder / "done.json"
        made_by = pathlib.Path(command[0])
        record = json.loads(done.read_text()) if done.exists() else {}
        if record.get("command") != command or done.stat().st_mtime < made_by.stat().st_mtime:
            log(f"running {self.label} on {self.data.name}")
            with open(self.folder / "log.txt", "w") as messages:
                try:
                    status = subprocess.run(command, stdout=messages, stderr=messages, timeout=7200).returncode
                except subprocess.TimeoutExpired:
                    status = 124
            record = {"command": command, "status": status}
            done.write_text(json.dumps(record))
        self.figures = {"status": record["status"], **self._judge(options)}
        return self

    def _judge(self, options):
        # Without compensation a scan is as it was at its middle, if at any one time.
        truth = self.data.truth_middle if self.method else self.data.truth
        command = [options.tool("pcl_floam_evaluate"), "--json", "--estimate", self.folder / "poses.kitti.txt",
                   "--ground-truth", truth]
        command += ["--calibration", self.data.calibration] if self.data.calibration else []
        judged = subprocess.run(command, capture_output=True, text=True)
        if judged.returncode != 0:
            return dict.fromkeys(["ate", "mean_error", "t_rel", "r_rel", "path", "ms"])
        accuracy = json.loads(judged.stdout)
        with open(self.folder / "timing.csv") as file:
            times = [float(row["total_ms"]) for row in csv.DictReader(file)]
        return {"ate": accuracy["ate"]["position_m"]["rms"], "mean_error": accuracy["ate"]["position_m"]["mean"],
                "t_rel": accuracy["kitti"]["t_rel_percent"], "r_rel": accuracy["kitti"]["r_rel_deg_per_100m"],
                "standard": accuracy["kitti"]["standard_lengths"], "path": accuracy["path_length_m"],
                "ms": statistics.median(times) if times else None}


def execute(options, runs, timed=False):
    """Executes runs: one after the other when their times are to be told, else several at a time."""
    with concurrent.futures.ThreadPoolExecutor(1 if timed else options.arguments.jobs) as pool:
        return list(pool.map(lambda run: run.execute(options), runs))


def compensation_modes(options):
    """The names that --compensation takes, from the tool itself."""
    text = subprocess.run([options.tool("pcl_floam_odometry"), "--help"], capture_output=True, text=True).stdout
    after = text.split("--compensation", 1)[1]
    names = next(word for word in after.split() if "|" in word)
    return names.split("|")


def default_compensation(options):
    text = subprocess.run([options.tool("pcl_floam_odometry"), "--help"], capture_output=True, text=True).stdout
    return text.split("--compensation", 1)[1].split("[", 1)[1].split("]", 1)[0]


def number(value, digits, factor=1.0):
    if value is None or not math.isfinite(value):
        return "–"
    return f"{factor * value:.{digits}f}"


def markdown(header, rows):
    lines = ["| " + " | ".join(map(str, header)) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def publish(options, tables):
    """Writes and prints the tables: (name, title, header, rows). One CSV file each, one Markdown file for all."""
    texts = []
    for name, title, header, rows in tables:
        with open(options.output / f"{name}.csv", "w", newline="") as file:
            csv.writer(file).writerows([header] + rows)
        texts.append(f"**{title}**\n\n{markdown(header, rows)}\n")
    text = "\n".join(texts)
    (options.output / f"{options.name}.md").write_text(text)
    print(text)
    log(f"written to {options.output}")


def bar_chart(options, name, title, unit, labels, series, logarithmic=False):
    """Groups of bars: `labels` below, `series` a list of (name, values); None leaves a bar out."""
    rows = [[label] + [values[i] for _, values in series] for i, label in enumerate(labels)]
    block = "\n".join('"{}" '.format(str(row[0]).replace('"', "'")) + " ".join(
        "NaN" if v is None or not math.isfinite(v) else f"{v:.6g}" for v in row[1:]) for row in rows)
    plots = ", ".join('$data using {}:xtic(1) title "{}"'.format(i + 2, s[0]) for i, s in enumerate(series))
    draw(f"""set terminal pngcairo noenhanced size 1000,520 font 'DejaVu Sans,10'
set output '{options.output / name}.png'
set title "{title}"
set style data histograms
set style histogram clustered gap 1
set style fill solid 0.85 noborder
set boxwidth 0.9
set border 3
set tics nomirror
set xtics rotate by -25
set grid ytics lc rgb '#e0e0e0'
set ylabel '{unit}'
set key outside right top
{'set logscale y' if logarithmic else 'set yrange [0:*]'}
$data << EOD
{block}
EOD
plot {plots}
""")


def draw(script):
    """Runs gnuplot; without it, or if it fails, the picture is missing and nothing else."""
    try:
        result = subprocess.run(["gnuplot"], input=script, text=True, capture_output=True)
        if result.returncode != 0:
            log("gnuplot: " + result.stderr.strip())
    except FileNotFoundError:
        log("no picture: gnuplot is not installed")


def positions(file):
    """The translations of a file of KITTI poses."""
    rows = [[float(word) for word in line.split()] for line in open(file) if line.strip()]
    return rows, [(row[3], row[7], row[11]) for row in rows]
