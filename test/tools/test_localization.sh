#!/usr/bin/env bash
# A map made on one way through the warehouse serves a robot that takes another way, among other workers, with other
# noise: its error stays below 3 cm.
set -euo pipefail
bin="$1"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

"$bin/pcl_floam_simulate" warehouse --seed 5 --scans 700 --output "$work/first" >/dev/null
"$bin/pcl_floam_simulate" warehouse --seed 5 --path 2 --scans 200 --output "$work/second" >/dev/null
"$bin/pcl_floam_odometry" "$work/first/scans" --output "$work/map" --plot none --quiet

# Where the second way begins, seen from the first scan of the map, which both poses have nearly level.
initial_pose="$(cat <(head -n 1 "$work/first/poses_end.txt") <(head -n 1 "$work/second/poses_end.txt") | awk '
  { x[NR] = $4; y[NR] = $8; z[NR] = $12; yaw[NR] = atan2($5, $1) }
  END {
    dx = x[2] - x[1]; dy = y[2] - y[1]; c = cos(yaw[1]); s = sin(yaw[1])
    printf "%.2f,%.2f,%.2f,%.1f", c * dx + s * dy, c * dy - s * dx, z[2] - z[1], (yaw[2] - yaw[1]) * 57.29578
  }')"
"$bin/pcl_floam_odometry" "$work/second/scans" --output "$work/localized" --map "$work/map" --localize \
  --initial-pose "$initial_pose" --ground-truth "$work/second/poses_end.txt" --plot none --quiet
python3 - "$work/localized/summary.json" <<'PYTHON'
import json, sys
summary = json.load(open(sys.argv[1]))
error = summary["accuracy"]["ate"]["position_m"]["rms"]
print("ATE", error, "m, tracked", summary["scans"]["tracked"])
sys.exit(0 if error < 0.03 and summary["scans"]["tracked"] == 200 else 1)
PYTHON
