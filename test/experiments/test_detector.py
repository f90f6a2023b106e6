"""The judgement of 09_detector.sh on small trajectories of which every verdict is known."""

import math
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples/experiments"))
import detector  # noqa: E402


def pose(x, y=0.0, yaw=0.0):
    c, s = math.cos(yaw), math.sin(yaw)
    return [c, -s, 0.0, x, s, c, 0.0, y, 0.0, 0.0, 1.0, 0.0]


def line(xs):
    return [pose(x) for x in xs]


class Calls(unittest.TestCase):
    def test_only_a_tracked_scan_that_stays_is_good(self):
        self.assertEqual(detector.call("tracked", False), "good")
        self.assertEqual(detector.call("initialized", False), "good")
        self.assertEqual(detector.call("tracked", True), "doubtful")
        self.assertEqual(detector.call("doubtful", False), "doubtful")
        self.assertEqual(detector.call("predicted", True), "lost")
        self.assertEqual(detector.call("not started", False), "lost")


class WrongScans(unittest.TestCase):
    TRUTH = line([0.0, 1.0, 2.0, 3.0, 4.0, 5.0])

    def wrong(self, xs, calls="gggggg"):
        names = {"g": "good", "d": "doubtful", "l": "lost"}
        return detector.wrong_scans(line(xs), self.TRUTH, [names[c] for c in calls])

    def test_what_is_exact_is_right(self):
        self.assertEqual(self.wrong([0, 1, 2, 3, 4, 5]), [False] * 6)

    def test_half_a_metre_and_a_hundredth_of_the_way_are_allowed(self):
        self.assertFalse(any(self.wrong([0, 1, 2.509, 3.509, 4.509, 5.509])))
        self.assertEqual(self.wrong([0, 1, 2.511, 3.511, 4.511, 5.511])[2], True)

    def test_a_jump_that_was_called_good_stays_wrong_until_the_pose_is_right_again(self):
        self.assertEqual(self.wrong([0, 1, 4, 5, 6, 5]), [False, False, True, True, True, False])

    def test_after_a_jump_that_was_told_the_rest_is_judged_by_its_own_motion(self):
        self.assertEqual(self.wrong([0, 1, 4, 5, 6, 7], "ggdggg"), [False, False, True, False, False, False])
        self.assertEqual(self.wrong([0, 1, 4, 5, 6, 7], "gglggg"), [False, False, True, False, False, False])

    def test_a_pose_that_is_found_again_after_a_gap_is_right(self):
        # Nothing is seen in the third and fourth scan; the prediction goes astray, the fifth is back.
        self.assertEqual(self.wrong([0, 1, 4, 7, 4, 5], "ggllgg"), [False, False, True, True, False, False])
        # The same where each step of the prediction is allowed.
        self.assertFalse(any(self.wrong([0, 1, 2.4, 3.8, 4, 5], "ggllgg")))

    def test_each_scan_is_judged_by_its_own_step_and_steps_that_are_wrong_add_up(self):
        # 0.4 m a scan never counts; 0.6 m does, as long as it is called good.
        self.assertFalse(any(self.wrong([0, 1.4, 2.8, 4.2, 5.6, 7.0])))
        self.assertEqual(self.wrong([0, 1.6, 3.2, 4.8, 6.4, 8.0]), [False] + [True] * 5)

    def test_the_motion_counts_not_the_frame(self):
        yaw = 1.0
        estimate = [pose(7.0 + i * math.cos(yaw), 3.0 + i * math.sin(yaw), yaw) for i in range(6)]
        self.assertFalse(any(detector.wrong_scans(estimate, self.TRUTH, ["good"] * 6)))


class SlippingScans(unittest.TestCase):
    def slipping(self, step, calls=None):
        count = 25
        estimate, truth = line([step * i for i in range(count)]), line(range(count))
        calls = calls or ["good"] * count
        wrong = detector.wrong_scans(estimate, truth, calls)
        self.assertFalse(any(wrong))
        return detector.slipping_scans(estimate, truth, calls, wrong)

    def test_over_a_second_small_errors_count(self):
        self.assertFalse(any(self.slipping(1.059)))
        self.assertEqual(self.slipping(1.061), [False] * 10 + [True] * 15)

    def test_only_where_all_of_the_second_was_called_good(self):
        calls = ["good"] * 25
        calls[12] = "doubtful"
        self.assertEqual(self.slipping(1.061, calls), [False] * 10 + [True] * 2 + [False] * 11 + [True] * 2)


class Covariance(unittest.TestCase):
    def test_three_sigma_along_the_error(self):
        covariance = [0.01, 0.0, 0.0, 1.0, 0.0, 1.0]
        self.assertTrue(detector.is_within([0.299, 0.0, 0.0], covariance))
        self.assertFalse(detector.is_within([0.301, 0.0, 0.0], covariance))
        self.assertTrue(detector.is_within([0.0, 2.99, 0.0], covariance))

    def test_what_goes_together_in_two_axes(self):
        # Along (1, 1) the variance is 0.19, along (1, -1) it is 0.01.
        covariance = [0.10, 0.09, 0.0, 0.10, 0.0, 0.10]
        along = lambda length, y: [length / math.sqrt(2.0), y * length / math.sqrt(2.0), 0.0]
        self.assertTrue(detector.is_within(along(1.3, 1.0), covariance))
        self.assertFalse(detector.is_within(along(0.31, -1.0), covariance))

    def test_no_error_is_within_none(self):
        self.assertTrue(detector.is_within([0.0, 0.0, 0.0], [0.0] * 6))
        self.assertFalse(detector.is_within([1e-6, 0.0, 0.0], [0.0] * 6))

    def test_both_scans_count_in_the_worlds_axes(self):
        # Driving along the world's y; 0.5 m off along the way, which is known to 0.12 m by each scan.
        quarter = math.pi / 2.0
        estimate = [pose(0.0, 0.0, quarter), pose(0.0, 1.5, quarter)]
        truth = [pose(0.0), pose(1.0)]
        along_y = [1e-6, 0.0, 0.0, 0.12 ** 2, 0.0, 1e-6]
        along_x = [0.12 ** 2, 0.0, 0.0, 1e-6, 0.0, 1e-6]
        self.assertEqual(detector.motions_within(estimate, truth, [along_y, along_y]), [True])
        self.assertEqual(detector.motions_within(estimate, truth, [along_y, [0.0] * 6]), [False])
        self.assertEqual(detector.motions_within(estimate, truth, [along_x, along_x]), [False])


def verdict(state, provisional="0", explained="0.9", told="0.01", variance="0.01", reason=""):
    result = {"state": state, "provisional": provisional, "explained": explained, "scan_only_deviation_m": told, "reason": reason}
    result.update({f"covariance_{a}_m2": variance if a[0] == a[1] else "0" for a in
                   ("xx", "xy", "xz", "yy", "yz", "zz")})
    return result


class Figures(unittest.TestCase):
    def test_a_run_is_counted(self):
        # The third scan jumps and is found, the fourth jumps and is not, the fifth comes back right but doubted.
        estimate = line([0.0, 1.0, 4.0, 7.0, 8.0, 8.0])
        truth = line([0.0, 1.0, 2.0, 3.0, 6.0, 6.0])
        verdicts = [verdict("initialized", explained="0"), verdict("tracked", "1"),
                    verdict("doubtful", explained="0.3", told="0.2"), verdict("tracked", explained="0.6"),
                    verdict("doubtful", explained="0.4"),
                    verdict("predicted", reason="too few points")]
        self.assertEqual(detector.judged(estimate, truth, verdicts), {
            "judged": 5, "wrong": 2, "slipping": 0, "found": 1, "right_lost": 1, "right_unseen": 1, "right_doubted": 2, "within": 2,
            "explained_of_wrong": [0.3, 0.6], "explained_of_right": [0.9, 0.4, 0.9],
            "told_of_wrong": [0.2, 0.01], "told_of_right": [0.01, 0.01, 0.01]})

    def test_a_scan_that_was_seen_and_lost_is_not_excused(self):
        poses = line([0.0, 1.0, 2.0])
        verdicts = [verdict("initialized"), verdict("predicted", reason="the map does not bear it out"),
                    verdict("tracked")]
        figures = detector.judged(poses, poses, verdicts)
        self.assertEqual((figures["right_lost"], figures["right_unseen"]), (1, 0))

    def test_the_curve_of_thresholds(self):
        self.assertEqual(detector.characteristic([0.1, 0.5], [0.4, 0.6, 0.7, 0.8]),
                         [(0.0, 0.0), (0.0, 50.0), (25.0, 50.0), (25.0, 100.0), (50.0, 100.0), (75.0, 100.0),
                          (100.0, 100.0)])
        self.assertIsNone(detector.share(0, 0))


if __name__ == "__main__":
    unittest.main()
