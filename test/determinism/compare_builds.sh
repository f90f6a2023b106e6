#!/usr/bin/env bash
# The same scans give the same poses: to the bit whatever the number of threads and the run, and to 1e-6 from the library
# without optimisation. That one is the user's project which compiles it within its own build: made here, unless the long
# tests have.
# usage: compare_builds.sh BUILD     an optimised build with the odometry tool and the simulator
set -euo pipefail
build=$(cd "$1" && pwd)
sources=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

plain=$build/test/consumer/in_one_build
[ -e "$plain/CMakeCache.txt" ] || cmake -S "$sources/test/consumer/in_one_build" -B "$plain" -DPCL_FLOAM_SOURCE="$sources" \
  -DWAY=add_subdirectory -DCMAKE_UNITY_BUILD=ON >/dev/null
cmake --build "$plain" --target track_scans --parallel 2 >/dev/null
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
"$plain/track_scans" "$work/data/scans" "$work/plain.txt"

for name in again threads2 threads3 threads8; do
  for file in poses.kitti.txt poses.tum.txt map_edges.pcd map_planes.pcd; do
    cmp "$work/once/$file" "$work/$name/$file"
  done
done
cmp "$work/features1/poses.kitti.txt" "$work/features3/poses.kitti.txt"
echo "poses and maps are equal to the bit: $(sha256sum <"$work/once/poses.kitti.txt" | cut -c 1-16)"
paste -d ' ' "$work/once/poses.kitti.txt" "$work/plain.txt" | awk '
  NF != 24 { exit 1 }
  { for (i = 1; i <= 12; ++i) { d = $i - $(i + 12); d = d < 0 ? -d : d; if (d > largest) largest = d } }
  END { printf "Without optimisation they differ by %g at most\n", largest; exit !(NR == 12 && largest <= 1e-6) }'
