"""Real drives and their simulated twins: what 10_real.sh judges beyond what all experiments do."""

import json
import math
import pathlib
import random
import subprocess

# What the makers of KITTI's drives state of their GPS and inertial sensor, an OXTS RT3003: A. Geiger, P. Lenz, C. Stiller
# and R. Urtasun, "Vision meets Robotics: The KITTI Dataset", IJRR 2013
GPS_POSITION = 0.02  # m
GPS_HEADING = 0.1  # degrees


def evaluated(options, folder, *words):
    """What pcl_floam_evaluate says of the poses of a run without ground truth; nothing if it fails."""
    command = [options.tool("pcl_floam_evaluate"), "--json", "--estimate", folder / "poses.kitti.txt", *words]
    judged = subprocess.run(command, capture_output=True, text=True)
    return json.loads(judged.stdout) if judged.returncode == 0 else {}


def at_rest(options, folder):
    """Of a sensor that stands: how far its pose wanders off the first one, and how much it changes from scan to scan,
    root mean square, m."""
    found = evaluated(options, folder, "--at-rest").get("rest", {})
    return {"wander": found.get("wander_m"), "jitter": found.get("jitter_rms_m")}


def first_scans(folder, truth, target, count):
    """A folder of the first scans of another, and a file of their true poses (None for None)."""
    (target / "scans").mkdir(parents=True, exist_ok=True)
    for file in sorted(folder.iterdir())[:count]:
        link = target / "scans" / file.name
        if not link.exists():
            link.symlink_to(file.resolve())
    if truth is None:
        return target / "scans", None
    (target / "poses.txt").write_text("".join(truth.read_text().splitlines(keepends=True)[:count]))
    return target / "scans", target / "poses.txt"


def as_camera(lidar):
    """A lidar's pose (x ahead, y left, z up) as that of a camera (x right, y down, z ahead) that looks the same way, as
    KITTI's benchmark has it: a row of 12 numbers."""
    axes = [(1, -1.0), (2, -1.0), (0, 1.0)]  # of the camera's x, y, z: the lidar's axis and its sign
    row = []
    for i, sign in axes:
        row += [sign * other * lidar[4 * i + k] for k, other in axes] + [sign * lidar[4 * i + 3]]
    return row


def camera_way(poses, target):
    """A file for the simulator's --trajectory, of the poses of a lidar."""
    rows = [[float(word) for word in line.split()] for line in open(poses) if line.strip()]
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text("".join(" ".join(f"{value:.9g}" for value in as_camera(row)) + "\n" for row in rows))
    return target


def wander(generator, deviation):
    """A function of time: a sum of sines of 2 to 40 s, as errors of GPS that an inertial sensor bridges."""
    waves = [(2.0 * math.pi / (2.0 * 20.0 ** (i / 4.0)), generator.uniform(0.0, 2.0 * math.pi)) for i in range(5)]
    return lambda t: deviation * math.sqrt(2.0 / len(waves)) * sum(math.sin(rate * t + phase) for rate, phase in waves)


def as_by_gps(truth, target, seed, up):
    """Exact poses, ten a second, with the errors that the truth of real drives has: a file.

    up: the axis of the body that points up or down, 0 to 2: 2 for a lidar, 1 for a camera."""
    generator = random.Random(seed)
    place, heading = [wander(generator, GPS_POSITION) for _ in range(3)], wander(generator, math.radians(GPS_HEADING))
    first, second = (up + 1) % 3, (up + 2) % 3
    rows = []
    for n, line in enumerate(line for line in truth.read_text().splitlines() if line.strip()):
        pose, t = [float(word) for word in line.split()], 0.1 * n
        sine, cosine = math.sin(heading(t)), math.cos(heading(t))
        for row in range(3):
            a, b = pose[4 * row + first], pose[4 * row + second]
            pose[4 * row + first], pose[4 * row + second] = cosine * a + sine * b, cosine * b - sine * a
            pose[4 * row + 3] += place[row](t)
        rows.append(" ".join(f"{value:.9g}" for value in pose) + "\n")
    target.write_text("".join(rows))
    return target


def sharpness(options, folder, scans):
    """How sharp a map the poses of a run make of scans; kept beside them, as it takes long."""
    kept = folder / "sharpness.json"
    if not kept.exists():
        kept.write_text(json.dumps(evaluated(options, folder, "--scans", scans).get("sharpness", {})))
    found = json.loads(kept.read_text())
    return {"spread": found.get("spread_across_planes_m"), "entropy": found.get("mean_map_entropy")}


def ratio(real, twin):
    return real / twin if real is not None and twin else None
