"""What 10_real.sh adds to the judgement: rest, the correction of KITTI's lasers, ways as a camera's."""

import array
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


class Raised(unittest.TestCase):
    def test_each_point_goes_up_by_the_angle_and_keeps_azimuth_range_and_intensity(self):
        points = array.array("f", [3.0, 4.0, -1.0, 0.5, -10.0, 2.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.1])
        result = real.raised(points, 2.0)
        for i in (0, 4):
            before, after = points[i:i + 4], result[i:i + 4]
            elevation = lambda p: math.degrees(math.atan2(p[2], math.hypot(p[0], p[1])))
            self.assertAlmostEqual(elevation(after) - elevation(before), 2.0, places=4)
            self.assertAlmostEqual(math.atan2(after[1], after[0]), math.atan2(before[1], before[0]), places=6)
            self.assertAlmostEqual(math.hypot(*after[:3]), math.hypot(*before[:3]), places=4)
            self.assertEqual(after[3], before[3])
        self.assertEqual(list(result[8:11]), [0.0, 0.0, 0.0])

    def test_scans_are_copied_whole_and_once(self):
        with tempfile.TemporaryDirectory() as place:
            folder, target = pathlib.Path(place) / "a", pathlib.Path(place) / "b"
            folder.mkdir()
            (folder / "0.bin").write_bytes(array.array("f", [1.0, 0.0, 0.0, 0.5] * 3).tobytes() + b"xy")
            real.raised_scans(folder, target, 1.0)
            self.assertEqual((target / "0.bin").stat().st_size, 48)
            (target / "0.bin").write_bytes(b"kept")
            real.raised_scans(folder, target, 1.0)
            self.assertEqual((target / "0.bin").read_bytes(), b"kept")


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


class Ratio(unittest.TestCase):
    def test_without_one_of_both_there_is_none(self):
        self.assertEqual(real.ratio(3.0, 2.0), 1.5)
        self.assertIsNone(real.ratio(None, 2.0))
        self.assertIsNone(real.ratio(1.0, None))
        self.assertIsNone(real.ratio(1.0, 0.0))


if __name__ == "__main__":
    unittest.main()
