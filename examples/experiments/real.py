"""Real drives and their simulated twins: what 10_real.sh judges beyond what all experiments do."""

import array
import json
import math
import pathlib
import subprocess
import sys

BYTES_OF_POINT = 16  # KITTI's x, y, z and intensity


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


def raised(points, degrees):
    """KITTI's points with every laser's elevation raised: what --vertical-correction of pcl_floam_odometry does."""
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    result = array.array("f", points)
    for i in range(0, len(points) - 3, 4):
        x, y, z = points[i], points[i + 1], points[i + 2]
        flat = math.hypot(x, y)
        scale = cosine - z * sine / flat if flat > 0.0 else 1.0
        result[i], result[i + 1], result[i + 2] = x * scale, y * scale, z * cosine + flat * sine
    return result


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


def raised_scans(folder, target, degrees):
    """Copies of KITTI's scans for programs that have no correction of their own. Returns their folder."""
    target.mkdir(parents=True, exist_ok=True)
    for file in sorted(folder.glob("*.bin")):
        if (target / file.name).exists():
            continue
        points = array.array("f")
        points.frombytes(file.read_bytes()[:file.stat().st_size // BYTES_OF_POINT * BYTES_OF_POINT])
        if sys.byteorder == "big":
            points.byteswap()
        part = target / (file.name + ".part")
        part.write_bytes(raised(points, degrees).tobytes())
        part.rename(target / file.name)
    return target


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


def sharpness(options, folder, scans):
    """How sharp a map the poses of a run make of scans; kept beside them, as it takes long."""
    kept = folder / "sharpness.json"
    if not kept.exists():
        kept.write_text(json.dumps(evaluated(options, folder, "--scans", scans).get("sharpness", {})))
    found = json.loads(kept.read_text())
    return {"spread": found.get("spread_across_planes_m"), "entropy": found.get("mean_map_entropy")}


def ratio(real, twin):
    return real / twin if real is not None and twin else None
