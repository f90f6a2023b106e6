"""What is kept of each run: one line of JSON in the output folder's records.jsonl. Tables are printed from these alone.

A record tells experiment, run, commit, date, command, data set and figures. Of several records of one run the last one
counts. Those of another commit than the present one are used as well, and every table says which commits its runs are of.
"""

import collections
import datetime
import functools
import json
import math
import pathlib
import subprocess
import threading

HERE = pathlib.Path(__file__).resolve().parents[2]
FILE = "records.jsonl"


@functools.lru_cache(maxsize=None)
def present_commit():
    """The repository's commit, with '-dirty' if something differs from it; 'unknown' outside of a repository."""

    def git(*words):
        return subprocess.run(["git", "-C", HERE, *words], capture_output=True, text=True, check=True).stdout.strip()

    try:
        return git("rev-parse", "HEAD") + ("-dirty" if git("status", "--porcelain") else "")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def finite(value):
    """The same without numbers that JSON has not: they become None."""
    if isinstance(value, dict):
        return {key: finite(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def read(folder, experiment=None, commit=None):
    """The records of a folder, oldest first; of one experiment, or of commits that begin so, if given."""
    file = pathlib.Path(folder) / FILE
    lines = file.read_text().splitlines() if file.exists() else []
    all_records = [json.loads(line) for line in lines if line.strip()]
    return [r for r in all_records if (experiment is None or r["experiment"] == experiment)
            and (commit is None or r["commit"].startswith(commit))]


class Records:
    """The records of one experiment in one folder."""

    def __init__(self, folder, experiment, commit=None):
        self.file = folder / FILE
        self.experiment = experiment
        self._last = {record["run"]: record for record in read(folder, experiment, commit)}
        self._used = {}
        self._lock = threading.Lock()

    def find(self, run):
        """The last record of a run, or None."""
        record = self._last.get(run)
        with self._lock:
            self._used.update({run: record} if record else {})
        return record

    def add(self, run, **content):
        record = finite({"experiment": self.experiment, "run": run, "commit": present_commit(),
                         "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="microseconds"),
                         **content})
        with self._lock:
            with open(self.file, "a") as file:
                file.write(json.dumps(record) + "\n")
            self._last[run] = self._used[run] = record
        return record

    def all(self):
        return list(self._last.values())

    def labels(self):
        return list(dict.fromkeys(record["label"] for record in self.all()))

    def of_data(self, key):
        """The values that the data sets of all records have there, in order and once each."""
        return list(dict.fromkeys(record["data"].get(key) for record in self.all()))

    def origin(self):
        """The commits of all records that were asked for so far, with their number."""
        counts = collections.Counter(record["commit"] for record in self._used.values())
        name = lambda commit: commit[:12] + ("-dirty" if commit.endswith("-dirty") else "")
        parts = [f"{n} of commit {name(commit)}" + (" (not the present one)" if commit != present_commit() else "")
                 for commit, n in counts.most_common()]
        return "Runs: " + (", ".join(parts) if parts else "none")


def time_of(record):
    """When it was made, s, as files' times are."""
    return datetime.datetime.fromisoformat(record["date"]).timestamp()
