#!/usr/bin/env bash
# The library on arm64, from an x86 machine with Debian: cross-compiles it with its tests, runs these under qemu, and
# compares the poses of short simulated drives with those of an x86 build, which must agree to 1e-6.
# Took 26 minutes on two shared cores with JOBS=1: 3 for the packages, 7 to compile for x86, 10 for arm64, 6 for tests and
# drives, which is all when nothing has changed. Keeps what it makes in build/arm64 (2.6 GB).
# JOBS=n builds n files at a time. Packages for arm64 are unpacked, not installed. qemu does not imitate an arm64's weaker
# order of memory accesses: faults of that kind would not show.
set -euo pipefail
cd "$(dirname "$0")/.."
kept=$PWD/build/arm64
sysroot=$kept/sysroot
trap '[ $? -eq 0 ] || echo "arm64: failed" >&2' EXIT

fail() {
  echo "arm64: $*" >&2
  exit 1
}
[ "$(dpkg --print-architecture)" = amd64 ] || fail "this compares with x86, and runs there"
bash cmake/install_packages.sh crossbuild-essential-arm64 qemu-user mmdebstrap

# What the library is built with, for arm64, from where this machine has its own packages.
make_sysroot() { # make_sysroot PACKAGES
  local lib=usr/lib/aarch64-linux-gnu link target
  rm -rf "$sysroot"
  mkdir -p "$sysroot"
  # shellcheck disable=SC2016
  apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
    sort -u | mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$1" --format=tar '' - - |
    tar -x -C "$sysroot" --no-same-owner --exclude='./dev/*' --exclude='./usr/share/doc/*'
  # A link to /lib means this machine's.
  find "$sysroot/usr/lib" -type l -lname '/*' | while read -r link; do
    target=$sysroot$(readlink "$link")
    ln -sfn "$(realpath -ms --relative-to="$(dirname "$link")" "$target")" "$link"
  done
  # So do libraries that packages of CMake name by their full path.
  # shellcheck disable=SC2016
  grep -rlE '[";]/usr/lib/aarch64-linux-gnu/' --include='*.cmake' "$sysroot/usr" |
    xargs sed -i -E 's#([";])(/usr/lib/aarch64-linux-gnu/)#\1${CMAKE_SYSROOT}\2#g'
  # Links that installing a package would have made.
  for target in blas lapack; do
    ln -sf "$target/lib$target.so" "$target/lib$target.so.3" "$sysroot/$lib/"
  done
  echo "$1" >"$sysroot/packages"
}
packages=$(grep -oE '\b[a-z0-9+-]+-dev\b' cmake/install_packages.sh | paste -sd,),libstdc++-12-dev
[ "$(cat "$sysroot/packages" 2>/dev/null)" = "$packages" ] || make_sysroot "$packages"

tests=(test_common test_evaluation test_filters test_scan_lines test_map test_motion test_odometry_parts test_odometry
       test_surface_registration test_registration_parts test_cloud_registration test_io test_recordings)
build() { # build NAME TARGETS [OPTION]...
  local name=$1 targets=$2
  shift 2
  cmake -S . -B "$kept/$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DPCL_FLOAM_INSTALL=OFF \
    -DPCL_FLOAM_WARNINGS_AS_ERRORS=ON "$@" >/dev/null 2>"$kept/$name.log" || fail "CMake: see $kept/$name.log"
  # shellcheck disable=SC2086
  ninja -C "$kept/$name" ${JOBS:+-j "$JOBS"} $targets
}
build x86 "pcl_floam_odometry pcl_floam_simulate"
build arm64 "pcl_floam_odometry ${tests[*]}" --toolchain "$PWD/test/arm64.cmake"

on_x86() { "$@"; }
on_arm64() { # on_arm64 PROGRAM [ARGUMENT]...
  OMP_WAIT_POLICY=passive qemu-aarch64 -L "$sysroot" "$@"
}
failed=()
passed=0
for name in "${tests[@]}" test_odometry_by_features; do
  echo "$name"
  program=${name%_by_features}
  variables=()
  [ "$program" = "$name" ] || variables=(-E PCL_FLOAM_TEST_FEATURES=1)
  on_arm64 "${variables[@]}" "$kept/arm64/test/$program" --gtest_brief=1 >"$kept/$name.log" 2>&1 || failed+=("$name")
  grep -E '^\[  (PASSED|FAILED|SKIPPED) ' "$kept/$name.log" || echo "  it crashed"
  passed=$((passed + $(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$kept/$name.log" | grep . || echo 0)))
done
[ ${#failed[@]} -eq 0 ] || fail "not all tests passed: ${failed[*]}; see $kept/test_*.log"
echo "$passed tests passed on arm64"

rm -rf "$kept/drives"
compare() { # compare WORLD ENGINE
  local drive=$kept/drives/$1 machine
  [ -e "$drive" ] ||
    "$kept/x86/bin/pcl_floam_simulate" "$1" --scans 25 --seed 1 --output "$drive" >/dev/null
  for machine in x86 arm64; do
    "on_$machine" "$kept/$machine/bin/pcl_floam_odometry" "$drive/scans" --engine "$2" --output "$drive/$2_$machine" \
      --plot none --quiet 2>"$drive/$2_$machine.log" || fail "$1, $2 on $machine: see $drive/$2_$machine.log"
  done
  paste -d ' ' "$drive/$2_x86/poses.kitti.txt" "$drive/$2_arm64/poses.kitti.txt" | awk -v drive="$1, $2" '
    NF != 24 { bad = 1 }
    { for (i = 1; i <= 12; ++i) { d = $i - $(i + 12); d = d < 0 ? -d : d; if (d > largest) largest = d } }
    END {
      printf "%s: poses differ from x86 by %g at most\n", drive, largest
      exit bad || NR != 25 || !(largest <= 1e-6)
    }' || fail "$1, $2: the poses are not those of x86"
}
for world in room warehouse handheld open-road; do
  for engine in surfaces features; do
    compare "$world" "$engine"
  done
done
echo "arm64: passed, after $((SECONDS / 60)) min"
