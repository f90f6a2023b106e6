"""What 10_real.sh adds to the judgement: rest, ways as a camera's, truth as by GPS."""

import math
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples/experiments"))
import real  # noqa: E402


class Evaluated(unittest.TestCase):
    """Figures are those of pcl_floam_evaluate; here a program that says which ones."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "evaluate"

    def tool(self, _name):
        return self.program

    def says(self, text, status=0):
        self.program.write_text(f"#!/bin/sh\necho '{text}'\nexit {status}\n")
        self.program.chmod(0o755)

    def test_rest_is_what_the_tool_says(self):
        self.says('{"rest": {"wander_m": 0.5, "jitter_rms_m": 0.25, "drift_m": 0.1}}')
        self.assertEqual(real.at_rest(self, self.folder), {"wander": 0.5, "jitter": 0.25})

    def test_a_tool_that_fails_gives_nothing(self):
        self.says('{"rest": {"wander_m": 0.5}}', status=2)
        self.assertEqual(real.at_rest(self, self.folder), {"wander": None, "jitter": None})


class FirstScans(unittest.TestCase):
    def test_scans_and_true_poses_are_cut_alike(self):
        with tempfile.TemporaryDirectory() as place:
            folder, target = pathlib.Path(place) / "a", pathlib.Path(place) / "b"
            folder.mkdir()
            for name in "312":
                (folder / f"{name}.bin").write_text(name)
            truth = pathlib.Path(place) / "truth.txt"
            truth.write_text("one\ntwo\nthree\n")
            for _ in range(2):  # the second time all is there
                scans, poses = real.first_scans(folder, truth, target, 2)
            self.assertEqual([file.read_text() for file in sorted(scans.iterdir())], ["1", "2"])
            self.assertEqual(poses.read_text(), "one\ntwo\n")
            self.assertIsNone(real.first_scans(folder, None, target, 2)[1])


class AsCamera(unittest.TestCase):
    def test_ahead_is_z_left_is_minus_x_and_up_is_minus_y(self):
        row = real.as_camera([1, 0, 0, 5.0, 0, 1, 0, 2.0, 0, 0, 1, 0.5])
        self.assertEqual(row, [1, 0, 0, -2.0, 0, 1, 0, -0.5, 0, 0, 1, 5.0])

    def test_a_turn_to_the_left_is_one_about_the_cameras_minus_y(self):
        c, s = math.cos(0.3), math.sin(0.3)
        row = real.as_camera([c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0])
        expected = [c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0]
        for value, wanted in zip(row, expected):
            self.assertAlmostEqual(value, wanted)


class AsByGps(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.truth = self.folder / "truth.txt"
        self.truth.write_text("".join(f"1 0 0 {n} 0 1 0 0 0 0 1 0\n" for n in range(2000)))

    def made(self, seed, up):
        file = real.as_by_gps(self.truth, self.folder / "made.txt", seed, up)
        return [[float(word) for word in line.split()] for line in file.read_text().splitlines()]

    def test_errors_are_of_the_size_stated_and_slow(self):
        rows = self.made(1, 2)
        sides = [row[7] for row in rows]
        self.assertAlmostEqual(math.sqrt(sum(y * y for y in sides) / len(sides)), real.GPS_POSITION, delta=0.005)
        self.assertLess(max(abs(b - a) for a, b in zip(sides, sides[1:])), real.GPS_POSITION)
        turns = [math.degrees(math.atan2(row[4], row[0])) for row in rows]
        self.assertAlmostEqual(math.sqrt(sum(a * a for a in turns) / len(turns)), real.GPS_HEADING, delta=0.02)

    def test_rotations_stay_such_about_the_axis_given(self):
        for row in self.made(2, 1):
            self.assertEqual(row[4:7], [0, 1, 0])
            self.assertAlmostEqual(row[0] * row[10] - row[2] * row[8], 1.0, places=6)

    def test_seeds_tell_them_apart(self):
        self.assertNotEqual(self.made(1, 2), self.made(2, 2))
        self.assertEqual(self.made(1, 2), self.made(1, 2))


class Ratio(unittest.TestCase):
    def test_without_one_of_both_there_is_none(self):
        self.assertEqual(real.ratio(3.0, 2.0), 1.5)
        self.assertIsNone(real.ratio(None, 2.0))
        self.assertIsNone(real.ratio(1.0, None))
        self.assertIsNone(real.ratio(1.0, 0.0))


if __name__ == "__main__":
    unittest.main()
