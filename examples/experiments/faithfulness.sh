#!/usr/bin/env bash
# The choices that the paper leaves open, each compared on real and simulated scans: a Markdown table on standard
# output, one row a choice; absolute trajectory error in cm (root mean square after rigid alignment).
#
#   bash examples/experiments/faithfulness.sh [BIN [WORK]]
#
# BIN holds the tools (default build/demo/bin), WORK takes scans and results (default build/faithfulness).
# KITTI's scans are used if ../shared/data/kitti_raw_0001 or $PCL_FLOAM_DATA/kitti_raw_0001 is there.
set -euo pipefail
here="$(cd "$(dirname "$0")/../.." && pwd)"
bin="${1:-$here/build/demo/bin}"
work="${2:-$here/build/faithfulness}"
real="${PCL_FLOAM_DATA:-$here/../shared/data}/kitti_raw_0001"
mkdir -p "$work"

# name world sensor seed scans
simulated=("warehouse-vlp16 warehouse vlp16 11 600" "handheld-vlp16 handheld vlp16 12 300"
           "urban-hdl32 urban hdl32 13 200" "corridor-vlp16 corridor vlp16 14 600")
names=()
[ -d "$real" ] && names+=(kitti-0001)
for entry in "${simulated[@]}"; do
  read -r name world sensor seed scans <<<"$entry"
  names+=("$name")
  [ -e "$work/$name/poses_end.txt" ] ||
    "$bin/pcl_floam_simulate" "$world" --sensor "$sensor" --seed "$seed" --scans "$scans" --output "$work/$name" >/dev/null
done

value() { # the number of KEY in SECTION, in PART, of a summary
  sed -n "/\"$2\"/,\$p" "$1" | sed -n "/\"$3\"/,\$p" | sed -n "s/.*\"$4\": *\([-0-9.e+]*\).*/\1/p" | head -n 1
}

cell() { # data set, options
  local data="$work/$1" out="$work/result" arguments=()
  if [ "$1" = kitti-0001 ]; then
    arguments=("$real/velodyne" --ground-truth "$real/poses.txt" --vertical-correction 0.205)
  else
    arguments=("$data/scans" --ground-truth "$data/poses_end.txt")
  fi
  if timeout 300 "$bin/pcl_floam_odometry" "${arguments[@]}" --output "$out" --plot none --quiet "${@:2}" 2>/dev/null; then
    awk -v ate="$(value "$out/summary.json" ate position_m rms)" 'BEGIN { printf "%.1f", 100 * ate }'
  else
    printf 'lost'
  fi
}

row() { # label, options
  printf '| %s |' "$1"
  for name in "${names[@]}"; do
    printf ' %s |' "$(cell "$name" "${@:2}")"
  done
  printf '\n'
}

printf '| |'; printf ' %s |' "${names[@]}"; printf '\n|---|'; printf -- '---|%.0s' "${names[@]}"; printf '\n'
row "**defaults**"
row "Eq. 1 as printed (mean of norms)" --smoothness mean-of-norms --edge-bend 0 --edge-threshold 0.3 --plane-threshold 0.3
row "Eq. 9 weights as printed" --weights printed
row "Eq. 9 weights inverted" --weights inverted
row "each weight set sums to 1" --weight-normalization sum-one
row "Eq. 9 as printed, each set sums to 1" --weights printed --weight-normalization sum-one
row "compensation: none" --compensation none
row "compensation: LOAM's iterative" --compensation loam
row "solver: Ceres" --solver ceres
row "search: FLANN KD-tree" --search kdtree
row "kernel: none" --kernel none
row "kernel: Huber" --kernel huber
row "kernel: Geman-McClure" --kernel geman-mcclure
row "no edges" --edges-per-sector 0
row "every scan a keyframe" --keyframe-translation 0 --keyframe-rotation 0
row "planes from 10 neighbours" --plane-neighbors 10
row "line ratio 3 (LOAM's)" --line-ratio 3
