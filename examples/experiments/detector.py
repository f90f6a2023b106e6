"""Whether what the odometry says of a scan can be relied on; the terms are those of 09_detector.sh."""

import csv
import math

ALLOWED = 0.5  # m
ALLOWED_OF_THE_WAY = 0.01
SECOND = 10  # scans
SIGMAS = 3.0
NOTHING_SEEN = "too few points"  # the reason of a scan without returns


def call(state, is_provisional):
    """What a user is told of a scan: 'good', 'doubtful' or 'lost'."""
    if state in ("predicted", "not started"):
        return "lost"
    return "good" if state in ("tracked", "initialized") and not is_provisional else "doubtful"


def motion(before, after):
    """From one pose (a row of KITTI's 12 numbers) to another, in the axes of the first, m."""
    step = [after[4 * i + 3] - before[4 * i + 3] for i in range(3)]
    return [sum(before[4 * i + k] * step[i] for i in range(3)) for k in range(3)]


def way_along(poses):
    """The length of the path up to each pose, m."""
    way = [0.0]
    for before, after in zip(poses, poses[1:]):
        way.append(way[-1] + math.hypot(*motion(before, after)))
    return way


class Drift:
    """How far an estimate is off between two scans."""

    def __init__(self, estimate, truth):
        self.estimate, self.truth, self.way = estimate, truth, way_along(truth)

    def is_allowed(self, since, scan):
        off = math.dist(motion(self.estimate[since], self.estimate[scan]), motion(self.truth[since], self.truth[scan]))
        return off <= ALLOWED + ALLOWED_OF_THE_WAY * (self.way[scan] - self.way[since])


def wrong_scans(estimate, truth, calls):
    """Whether each scan's motion is off by more than is allowed, both since the last scan that was right and called good
    and since the last one of which the user was told, if that came later: the pose may have been found again."""
    drift = Drift(estimate, truth)
    right, told, wrong = 0, 0, [False]
    for i in range(1, len(estimate)):
        wrong.append(not drift.is_allowed(right, i) and not drift.is_allowed(max(right, told), i))
        if calls[i] != "good":
            told = i
        elif not wrong[i]:
            right = i
    return wrong


def slipping_scans(estimate, truth, calls, wrong):
    """Scans none of which is wrong by itself, nor any in the second before, all called good, but over which the pose has
    moved off by more than is allowed."""
    drift = Drift(estimate, truth)
    trusted = [c == "good" and not w for c, w in zip(calls, wrong)]
    return [i >= SECOND and all(trusted[i - SECOND:i + 1]) and not drift.is_allowed(i - SECOND, i)
            for i in range(len(estimate))]


def is_within(error, covariance):
    """Whether an error lies within three sigma along its own direction. `covariance`: xx, xy, xz, yy, yz, zz."""
    x, y, z = error
    xx, xy, xz, yy, yz, zz = covariance
    squared = x * x + y * y + z * z
    variance = x * x * xx + y * y * yy + z * z * zz + 2.0 * (x * y * xy + x * z * xz + y * z * yz)
    return squared == 0.0 or squared * squared <= SIGMAS ** 2 * variance


def motions_within(estimate, truth, covariances):
    """For each motion from scan to scan whether its error is within what both scans' covariances tell."""
    result = []
    for i in range(1, len(estimate)):
        before = estimate[i - 1]
        off = [e - t for e, t in zip(motion(before, estimate[i]), motion(truth[i - 1], truth[i]))]
        in_world = [sum(before[4 * row + k] * off[k] for k in range(3)) for row in range(3)]
        result.append(is_within(in_world, [a + b for a, b in zip(covariances[i - 1], covariances[i])]))
    return result


def share(part, whole):
    """In per cent; None of nothing."""
    return 100.0 * part / whole if whole else None


def judged(estimate, truth, verdicts):
    """The figures of one run. `verdicts`: rows of scans.csv, one for each pose."""
    calls = [call(v["state"], v["provisional"] == "1") for v in verdicts]
    wrong = wrong_scans(estimate, truth, calls)
    columns = [f"covariance_{axes}_m2" for axes in ("xx", "xy", "xz", "yy", "yz", "zz")]
    within = motions_within(estimate, truth, [[float(v[column]) for column in columns] for v in verdicts])
    moved = range(1, len(estimate))  # nothing is asked of the first scan
    figure = lambda name, is_wrong: [round(float(verdicts[i][name]), 4) for i in moved if wrong[i] == is_wrong]
    count = lambda is_wrong, *names: sum(wrong[i] == is_wrong and calls[i] in names for i in moved)
    unseen = sum(not wrong[i] and calls[i] == "lost" and verdicts[i]["reason"] == NOTHING_SEEN for i in moved)
    return {"judged": len(moved), "wrong": sum(wrong),
            "slipping": sum(slipping_scans(estimate, truth, calls, wrong)), "found": count(True, "doubtful", "lost"),
            "right_lost": count(False, "lost"), "right_unseen": unseen, "right_doubted": count(False, "doubtful"),
            "within": sum(within),
            "explained_of_wrong": figure("explained", True), "explained_of_right": figure("explained", False),
            "told_of_wrong": figure("scan_only_deviation_m", True), "told_of_right": figure("scan_only_deviation_m", False)}


def judge_run(run):
    """The same from the files of a run; nothing if it ended early."""
    poses, scans = run.folder / "poses.kitti.txt", run.folder / "scans.csv"
    if not poses.exists() or not scans.exists():
        return {}
    estimate, truth = ([[float(word) for word in line.split()] for line in open(file) if line.strip()]
                       for file in (poses, run.data.truth))
    with open(scans, newline="") as file:
        verdicts = list(csv.DictReader(file))
    if len(estimate) != len(truth) or len(verdicts) != len(truth):
        return {}
    return judged(estimate, truth, verdicts)


def characteristic(of_wrong, of_right):
    """Share of right scans doubted and of wrong scans found, in per cent, if those were doubted that have less than a
    threshold, for all thresholds."""
    wrong, right = sorted(of_wrong), sorted(of_right)
    points, found, doubted = [(0.0, 0.0)], 0, 0
    for threshold in sorted(set(wrong + right)):
        while found < len(wrong) and wrong[found] <= threshold:
            found += 1
        while doubted < len(right) and right[doubted] <= threshold:
            doubted += 1
        points.append((share(doubted, len(right)) or 0.0, share(found, len(wrong)) or 0.0))
    return points
