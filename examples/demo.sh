#!/usr/bin/env bash
# Installs what is needed, builds, and runs the odometry.
#
#   bash examples/demo.sh                            simulates a lidar in a warehouse and tracks it
#   bash examples/demo.sh SCANS [OPTION ...]         tracks your scans; options as of pcl_floam_odometry
#
# Results are in build/demo/result: trajectory.svg and map.png to look at, poses, map_edges.pcd and map_planes.pcd.
set -euo pipefail
here="$(cd "$(dirname "$0")/.." && pwd)"

bash "$here/cmake/install_packages.sh"
cmake -S "$here" -B "$here/build/demo" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
  -DPCL_FLOAM_BUILD_TESTS=OFF >/dev/null
targets=(pcl_floam_odometry)
if cmake --build "$here/build/demo" --target help | grep -q '^pcl_floam_simulate:'; then
  targets+=(pcl_floam_simulate)
fi
cmake --build "$here/build/demo" --target "${targets[@]}"
bin="$here/build/demo/bin"
result="$here/build/demo/result"

if [ $# -gt 0 ]; then
  "$bin/pcl_floam_odometry" "$@" --output "$result"
elif [ ! -x "$bin/pcl_floam_simulate" ]; then
  echo "The simulator was not built: it needs Embree 3. Give a folder of scans instead." >&2
  exit 1
else
  data="$here/build/demo/warehouse"
  [ -e "$data/poses_end.txt" ] || "$bin/pcl_floam_simulate" warehouse --output "$data"
  "$bin/pcl_floam_odometry" "$data/scans" --ground-truth "$data/poses_end.txt" --output "$result"
fi
