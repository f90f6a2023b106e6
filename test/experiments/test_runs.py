"""When an experiment runs a program, and when a record is enough: with programs that only note that they were called."""

import json
import os
import pathlib
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples/experiments"))
import support  # noqa: E402

ODOMETRY = """#!/bin/sh
while [ "$1" != --output ]; do shift; done
echo called >> "{calls}"
echo 1 0 0 0 0 1 0 0 0 0 1 0 > "$2/poses.kitti.txt"
printf 'scan,total_ms\\n0,3\\n1,5\\n2,100\\n' > "$2/timing.csv"
"""
EVALUATE = """#!/bin/sh
echo '{{"ate": {{"position_m": {{"rms": {ate}, "mean": 0.2}}}}, "path_length_m": 7.0,
  "kitti": {{"t_rel_percent": 1.5, "r_rel_deg_per_100m": 0.1, "standard_lengths": false}}}}'
"""


class Runs(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.place.name)
        (self.root / "bin").mkdir()
        self.program("pcl_floam_odometry", ODOMETRY.format(calls=self.root / "calls"))
        self.program("pcl_floam_evaluate", EVALUATE.format(ate=0.25))

    def tearDown(self):
        self.place.cleanup()

    def program(self, name, text):
        file = self.root / "bin" / name
        file.write_text(text)
        file.chmod(0o755)

    def calls(self):
        file = self.root / "calls"
        return len(file.read_text().splitlines()) if file.exists() else 0

    def run_once(self, *options, arguments=(), timed=False):
        sys.argv = ["test", "--bin", str(self.root / "bin"), "--output", str(self.root / "output"), *options]
        data = support.Dataset("drive", self.root / "scans", self.root / "truth.txt", world="room", seed=3)
        run = support.Run(data, "defaults", arguments, judge=lambda run: {"mine": float("inf")})
        return support.execute(support.Options("test", "a test"), [run], timed)[0]

    def records(self):
        return [json.loads(line) for line in (self.root / "output/records.jsonl").read_text().splitlines()]

    def test_a_run_leaves_its_figures_in_a_record(self):
        figures = self.run_once().figures
        self.assertEqual((figures["ate"], figures["ms"], figures["status"], figures["mine"]), (0.25, 5.0, 0, None))
        record, = self.records()
        self.assertEqual(record["figures"], dict(figures))
        self.assertEqual((record["data"]["world"], record["data"]["seed"]), ("room", 3))
        self.assertEqual(record["command"][0], str(self.root / "bin/pcl_floam_odometry"))

    def test_what_is_recorded_is_not_run_again_until_something_changes(self):
        for _ in range(2):
            self.run_once()
        self.assertEqual((self.calls(), len(self.records())), (1, 1))
        self.run_once(arguments=["--other"])
        self.assertEqual((self.calls(), len(self.records())), (2, 2))
        self.run_once(arguments=["--other"], timed=True)  # the time was not measured alone
        self.assertEqual(self.calls(), 3)
        newer = time.time() + 5.0
        os.utime(self.root / "bin/pcl_floam_odometry", (newer, newer))
        self.run_once(arguments=["--other"], timed=True)
        self.assertEqual(self.calls(), 4)

    def test_another_judgement_makes_another_record_without_a_run(self):
        self.run_once()
        self.program("pcl_floam_evaluate", EVALUATE.format(ate=0.5))
        self.assertEqual(self.run_once().figures["ate"], 0.5)
        self.assertEqual((self.calls(), len(self.records())), (1, 2))

    def test_tables_alone_run_nothing(self):
        self.assertFalse(self.run_once("--tables").is_recorded)
        self.assertIsNone(self.run_once("--tables").figures["ate"])
        self.run_once("--quick")
        (self.root / "bin/pcl_floam_evaluate").unlink()
        run = self.run_once("--tables")
        self.assertEqual((run.is_recorded, run.figures["ate"], self.calls()), (True, 0.25, 1))
        self.assertFalse(self.run_once("--tables", "--commit", "none").is_recorded)


if __name__ == "__main__":
    unittest.main()
