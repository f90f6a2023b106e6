"""Records of runs: what is written is found again, the last one counts, and tables say of which commit they are."""

import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples/experiments"))
import records  # noqa: E402


class RunRecords(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def add(self, run, ate, experiment="01_warehouse"):
        data = {"name": run, "world": "warehouse", "seed": 21}
        return records.Records(self.folder, experiment).add(run, label="defaults", data=data, figures={"ate": ate})

    def test_a_record_tells_all_that_is_needed_to_repeat_it(self):
        self.add("a", 0.5)
        record = json.loads((self.folder / "records.jsonl").read_text())
        self.assertEqual((record["experiment"], record["run"], record["figures"]), ("01_warehouse", "a", {"ate": 0.5}))
        self.assertEqual(record["commit"], records.present_commit())
        self.assertGreater(records.time_of(record), 1.7e9)

    def test_the_last_record_of_a_run_counts(self):
        self.add("a", 0.5)
        self.add("b", 0.7)
        self.add("a", 0.6)
        kept = records.Records(self.folder, "01_warehouse")
        self.assertEqual(kept.find("a")["figures"]["ate"], 0.6)
        self.assertEqual(len(kept.all()), 2)
        self.assertEqual(len((self.folder / "records.jsonl").read_text().splitlines()), 3)
        self.assertIsNone(kept.find("c"))

    def test_a_record_that_was_just_made_counts_as_well(self):
        kept = records.Records(self.folder, "01_warehouse")
        self.assertEqual(kept.origin(), "Runs: none")
        kept.add("a", label="defaults", data={}, figures={"ate": 0.5})
        self.assertEqual(kept.find("a")["figures"]["ate"], 0.5)
        self.assertTrue(kept.origin().startswith("Runs: 1 of commit"))

    def test_other_experiments_in_the_same_folder_stay_apart(self):
        self.add("a", 0.5, "02_room")
        self.assertIsNone(records.Records(self.folder, "01_warehouse").find("a"))
        self.assertEqual(records.Records(self.folder, "02_room").of_data("seed"), [21])

    def test_what_is_no_number_is_nothing(self):
        self.add("a", float("nan"))
        self.assertIsNone(records.Records(self.folder, "01_warehouse").find("a")["figures"]["ate"])

    def test_commits_are_told_and_can_be_chosen(self):
        self.add("a", 0.5)
        self.add("b", 0.6)
        file = self.folder / "records.jsonl"
        lines = [json.loads(line) for line in file.read_text().splitlines()]
        lines[0]["commit"] = "0123456789abcdef-dirty"
        file.write_text("".join(json.dumps(line) + "\n" for line in lines))
        kept = records.Records(self.folder, "01_warehouse")
        kept.find("a")
        self.assertEqual(kept.origin(), "Runs: 1 of commit 0123456789ab-dirty (not the present one)")
        kept.find("b")
        self.assertEqual(kept.origin().count("1 of commit"), 2)
        chosen = records.Records(self.folder, "01_warehouse", "01234")
        self.assertIsNone(chosen.find("b"))
        self.assertEqual(chosen.find("a")["figures"]["ate"], 0.5)


if __name__ == "__main__":
    unittest.main()
