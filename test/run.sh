#!/usr/bin/env bash
# Installs what is needed, builds library, tools and tests in build/test and runs the tests. Arguments go to CMake.
# Long tests: cmake --build build/test --target long_tests && (cd build/test && ctest -C Long -L long)
set -euo pipefail
cd "$(dirname "$0")/.."

bash cmake/install_packages.sh
cmake -S . -B build/test -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON "$@"
cmake --build build/test
cd build/test && ctest --output-on-failure -j "$(nproc)"
