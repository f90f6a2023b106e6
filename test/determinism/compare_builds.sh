#!/usr/bin/env bash
# The same scans give the same poses: to the bit whatever the number of threads and the run, and to 1e-6 in an
# unoptimised build, which this makes in BUILD/debug.
# usage: compare_builds.sh BUILD     an optimised build with the odometry tool and the simulator
set -euo pipefail
build=$(cd "$1" && pwd)
sources=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake -S "$sources" -B "$build/debug" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_UNITY_BUILD=ON \
  -DPCL_FLOAM_BUILD_TESTS=OFF -DPCL_FLOAM_INSTALL=OFF >/dev/null
cmake --build "$build/debug" --target pcl_floam_odometry >/dev/null
"$build/bin/pcl_floam_simulate" warehouse --scans 12 --seed 4 --output "$work/data" >/dev/null

run() { # run NAME TOOL [OPTION]...
  local name=$1 tool=$2
  shift 2
  "$tool" "$work/data/scans" --output "$work/$name" --plot none --quiet "$@"
}
release=$build/bin/pcl_floam_odometry
run once "$release"
run again "$release"
for threads in 2 3 8; do
  run "threads$threads" "$release" --threads "$threads"
done
for threads in 1 3; do
  run "features$threads" "$release" --engine features --threads "$threads"
done
run debug "$build/debug/bin/pcl_floam_odometry"

for name in again threads2 threads3 threads8; do
  for file in poses.kitti.txt poses.tum.txt map_edges.pcd map_planes.pcd; do
    cmp "$work/once/$file" "$work/$name/$file"
  done
done
cmp "$work/features1/poses.kitti.txt" "$work/features3/poses.kitti.txt"
echo "poses and maps are equal to the bit: $(sha256sum <"$work/once/poses.kitti.txt" | cut -c 1-16)"
paste -d ' ' "$work/once/poses.kitti.txt" "$work/debug/poses.kitti.txt" | awk '
  NF != 24 { exit 1 }
  { for (i = 1; i <= 12; ++i) { d = $i - $(i + 12); d = d < 0 ? -d : d; if (d > largest) largest = d } }
  END { printf "Debug and Release differ by %g at most\n", largest; exit !(NR == 12 && largest <= 1e-6) }'
