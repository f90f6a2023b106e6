"""What the experiments share: options, simulated data, runs and their judgement. Python's library only.

Simulated scans are kept in the data folder and made once. A result is kept as long as its record (records.py) is newer
than its program, so that an experiment that was stopped goes on where it was, and one whose program was rebuilt starts
afresh. With --tables nothing is run: tables show what the records have.
"""

import argparse
import collections
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

from pictures import bar_chart, curves, draw, log, markdown, number, publish
from records import HERE, Records, finite, time_of

USUAL_FOLDER = pathlib.Path(os.environ.get("TMPDIR", "/tmp")) / "pcl_floam_experiments"


class Options:
    """The command line that all experiments have; further arguments by `add`, a function of the parser."""

    def __init__(self, name, description, add=None):
        parser = argparse.ArgumentParser(prog=name + ".sh", description=description)
        parser.add_argument("--quick", action="store_true", help="short runs, to see that all works")
        parser.add_argument("--data", type=pathlib.Path, default=USUAL_FOLDER / "data", help="cache of simulated scans")
        parser.add_argument("--output", type=pathlib.Path, default=USUAL_FOLDER / name, help="tables, pictures, results")
        parser.add_argument("--bin", type=pathlib.Path, default=HERE / "build/demo/bin", help="folder of the tools")
        parser.add_argument("--jobs", type=int, default=2, help="runs at a time, where no time is measured")
        parser.add_argument("--tables", action="store_true", help="run nothing, print the tables of the records")
        parser.add_argument("--commit", help="with --tables: only of records whose commit begins so")
        if add:
            add(parser)
        self.arguments = parser.parse_args()
        self.name, self.output, self.tables_only = name, self.arguments.output, self.arguments.tables
        self.output.mkdir(parents=True, exist_ok=True)
        self.records = Records(self.output, name, self.arguments.commit if self.tables_only else None)
        kept = self.records.all()
        self.quick = all(record["quick"] for record in kept) if self.tables_only and kept else self.arguments.quick
        if not self.tables_only:
            self._require_tools()

    def _require_tools(self):
        wanted = ["pcl_floam_odometry", "pcl_floam_evaluate", "pcl_floam_simulate", "pcl_floam_pcl_odometry"]
        build = HERE / "build/demo"
        if self.arguments.bin == build / "bin" and not all((build / "bin" / tool).exists() for tool in wanted):
            log("building the tools in " + str(build))
            subprocess.run(["cmake", "-S", HERE, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DCMAKE_UNITY_BUILD=ON", "-DPCL_FLOAM_BUILD_TESTS=OFF"], check=True, stdout=subprocess.DEVNULL)
            subprocess.run(["cmake", "--build", build, "--target"] + wanted, check=True, stdout=sys.stderr)

    def tool(self, name):
        file = self.arguments.bin / name
        if not file.exists():
            sys.exit(f"{file}: not there; it is made by: cmake --build BUILD --target {name}")
        return file


class Dataset:
    """Scans with true poses at the sweep's end and middle; truth None: there is none. What `told` says of them goes into
    the records."""

    def __init__(self, name, scans, truth, truth_middle=None, odometry_options=(), calibration=None, **told):
        self.name, self.scans, self.truth = name, scans, truth
        self.truth_middle = truth_middle or truth
        self.odometry_options = list(odometry_options)
        self.calibration = calibration
        self.description = {"name": name, **{key: told.get(key) for key in
                                             ("world", "sensor", "family", "seed", "count", "options")}}

    def judge_at_the_middle(self):
        """Where the last return, the end of a sweep for the odometry, comes long before the turn ends."""
        self.truth = self.truth_middle
        self.odometry_options += ["--pose-instant", "middle"]


def simulate(options, plans, family="report", realism="real"):
    """Makes what is not there yet, several at a time. A plan: (world, sensor or None, seed, scans or 0, extra options, of
    which --family and --realism go before the arguments; None: the simulator's default). Returns the data sets in the
    plans' order."""
    usual = [("--family", family), ("--realism", realism)]

    def one(plan):
        world, sensor, seed, scans, extra = plan
        extra = [str(word) for word in extra]
        extra += [word for name, value in usual if value and name not in extra for word in (name, value)]
        parts = [world, sensor or "usual", f"seed{seed}", f"{scans}scans" if scans else "all"]
        name = "-".join(parts + [pathlib.Path(word).stem if "/" in word else word.strip("-") for word in extra])
        folder = options.arguments.data / name
        if not options.tables_only and not (folder / "poses_end.txt").exists():
            command = [world, "--seed", seed] + (["--sensor", sensor] if sensor else [])
            make(options, folder, command + (["--scans", scans] if scans else []) + extra)
        drawn_of = extra[extra.index("--family") + 1] if "--family" in extra else "tune"
        return Dataset(name, folder / "scans", folder / "poses_end.txt", folder / "poses_middle.txt", world=world,
                       sensor=sensor, family=drawn_of, seed=seed, count=scans or None, options=extra)

    with concurrent.futures.ThreadPoolExecutor(options.arguments.jobs) as pool:
        return list(pool.map(one, plans))


def make(options, folder, arguments):
    """Lets the simulator make a folder, which is there only when it is complete."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    making = pathlib.Path(tempfile.mkdtemp(dir=folder.parent, prefix="making-"))
    log("simulating " + folder.name)
    subprocess.run([options.tool("pcl_floam_simulate"), *map(str, arguments), "--output", making], check=True,
                   stderr=subprocess.DEVNULL)
    if folder.exists():
        shutil.rmtree(folder)
    making.rename(folder)


class Run:
    """One program on one data set. `figures` has, after `execute`: ate and mean_error (m), t_rel (%), r_rel
    (degree/100 m), path (m), ms (median), exit status, and what `judge`, a function of the run, adds to them; None for
    each that there is not. With --tables they are those of the record, if there is one (`is_recorded`)."""

    def __init__(self, data, label, arguments=(), method=None, judge=None):
        self.data, self.label, self.arguments, self.method = data, label, [str(a) for a in arguments], method
        self.judge = judge or (lambda run: {})
        self.name = "".join(c if c.isalnum() or c in ".-" else "_" for c in f"{data.name}-{label}")
        self.figures, self.is_recorded, self.folder = {}, False, None

    def _command(self, options):
        if self.method:
            command = [options.tool("pcl_floam_pcl_odometry"), "--method", self.method]
        else:
            command = [options.tool("pcl_floam_odometry"), "--quiet", "--plot", "png"] + self.data.odometry_options
            command += ["--ground-truth", self.data.truth] if self.data.truth else []
            command += ["--calibration", self.data.calibration] if self.data.calibration else []
        return [str(word) for word in command + [self.data.scans, "--output", self.folder] + self.arguments]

    def execute(self, options, timed=False):
        self.folder = options.output / "runs" / self.name
        record = options.records.find(self.name)
        if not options.tables_only:
            record = self._up_to_date(options, record, timed)
        self.is_recorded = record is not None
        self.figures = collections.defaultdict(lambda: None, record["figures"] if record else {})
        return self

    def _up_to_date(self, options, record, timed):
        """The record, or a new one if there is none, the program is newer, or it is judged otherwise now."""
        command = self._command(options)
        made_by = pathlib.Path(command[0]).stat().st_mtime
        is_done = (record is not None and record["command"] == command and time_of(record) > made_by
                   and (record["timed"] or not timed))
        if is_done and not (self.folder / "poses.kitti.txt").exists():
            return record
        status = record["figures"]["status"] if is_done else self._run(command)
        figures = finite({"status": status, **self._accuracy(options), **self._median_time()})
        figures.update(finite(self.judge(self)))
        if is_done and record["figures"] == figures:
            return record
        return options.records.add(self.name, label=self.label, command=command, data=self.data.description,
                                   quick=options.quick, timed=timed, figures=figures)

    def _run(self, command):
        log(f"running {self.label} on {self.data.name}")
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        with open(self.folder / "log.txt", "w") as messages:
            try:
                return subprocess.run(command, stdout=messages, stderr=messages, timeout=7200).returncode
            except subprocess.TimeoutExpired:
                return 124

    def _accuracy(self, options):
        # Without compensation a scan is as it was at its middle, if at any one time.
        truth = self.data.truth_middle if self.method else self.data.truth
        if truth is None:
            return {}
        command = [options.tool("pcl_floam_evaluate"), "--json", "--estimate", self.folder / "poses.kitti.txt",
                   "--ground-truth", truth]
        command += ["--calibration", self.data.calibration] if self.data.calibration else []
        judged = subprocess.run(command, capture_output=True, text=True)
        if judged.returncode != 0:
            return {}
        accuracy = json.loads(judged.stdout)
        return {"ate": accuracy["ate"]["position_m"]["rms"], "mean_error": accuracy["ate"]["position_m"]["mean"],
                "t_rel": accuracy["kitti"]["t_rel_percent"], "r_rel": accuracy["kitti"]["r_rel_deg_per_100m"],
                "standard": accuracy["kitti"]["standard_lengths"], "path": accuracy["path_length_m"]}

    def _median_time(self):
        file = self.folder / "timing.csv"
        rows = list(csv.DictReader(file.read_text().splitlines())) if file.exists() else []
        return {"ms": statistics.median(float(row["total_ms"]) for row in rows)} if rows else {}

    def copy_picture(self, target):
        """Copies the picture of the path, if there is one."""
        if self.folder and (self.folder / "trajectory.png").exists():
            shutil.copy(self.folder / "trajectory.png", target)


def execute(options, runs, timed=False):
    """Executes runs: one after the other when their times are to be told, else several at a time."""
    with concurrent.futures.ThreadPoolExecutor(1 if timed else options.arguments.jobs) as pool:
        return list(pool.map(lambda run: run.execute(options, timed), runs))


def doubted(run):
    """How many scans are not called tracked, and how many there are; nothing if the run ended early."""
    file = run.folder / "scans.csv"
    rows = list(csv.DictReader(file.read_text().splitlines())) if file.exists() else []
    return {"doubted": sum(row["state"] not in ("tracked", "initialized") for row in rows), "scans": len(rows)}


def compensation_modes(options):
    """The names that --compensation takes, from the tool itself."""
    text = subprocess.run([options.tool("pcl_floam_odometry"), "--help"], capture_output=True, text=True).stdout
    after = text.split("--compensation", 1)[1]
    names = next(word for word in after.split() if "|" in word)
    return names.split("|")


def default_compensation(options):
    text = subprocess.run([options.tool("pcl_floam_odometry"), "--help"], capture_output=True, text=True).stdout
    return text.split("--compensation", 1)[1].split("[", 1)[1].split("]", 1)[0]


def real_data(name):
    """Where real data lies: in $PCL_FLOAM_DATA, or beside the repository."""
    return pathlib.Path(os.environ.get("PCL_FLOAM_DATA", HERE / "../shared/data")).resolve() / name


def positions(file):
    """The translations of a file of KITTI poses."""
    rows = [[float(word) for word in line.split()] for line in open(file) if line.strip()]
    return rows, [(row[3], row[7], row[11]) for row in rows]
