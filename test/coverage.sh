#!/usr/bin/env bash
# Line and branch coverage of include/ and src/ by the tests, measured in build/coverage (gcovr; Debian: gcovr).
# JOBS=n builds n files at a time. Arguments go to gcovr, e.g. --html-details build/coverage/index.html
set -euo pipefail
cd "$(dirname "$0")/.."

# The programs of the library's tests; those of the simulator and of other people's builds cover nothing more.
programs() {
  sed -n 's/^ *pcl_floam_add\(_long\)\?_test(\([a-z0-9_]\+\).*/\2/p' test/CMakeLists.txt test/fuzz/CMakeLists.txt |
    grep -vE '^test_(simulation|other_alignment|tool_parts|registration_own_point_types|registration_visualizer)$'
}

cmake -S . -B build/coverage -G Ninja -DCMAKE_BUILD_TYPE=None -DPCL_FLOAM_INSTALL=OFF \
  -DCMAKE_CXX_FLAGS="-O1 --coverage -fprofile-update=atomic" >/dev/null
# shellcheck disable=SC2046
ninja -C build/coverage ${JOBS:+-j "$JOBS"} $(programs)
find build/coverage -name '*.gcda' -delete
for program in $(programs); do
  "$(find build/coverage/test -type f -name "$program" -perm -u+x)" --gtest_brief=1 || echo "$program failed" >&2
done
PCL_FLOAM_TEST_FEATURES=1 build/coverage/test/test_odometry --gtest_brief=1 || echo "test_odometry by features failed" >&2
# Branches that only an exception takes, as of an allocation that fails, are not counted.
gcovr --root . --filter include/ --filter src/ --exclude-throw-branches --exclude-unreachable-branches \
  --gcov-ignore-parse-errors --print-summary --sort-percentage "$@" build/coverage
