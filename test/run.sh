#!/usr/bin/env bash
# Installs what is needed, builds everything in build/test and runs all tests. Arguments go to CMake.
set -euo pipefail
cd "$(dirname "$0")/.."

bash cmake/install_packages.sh
cmake -S . -B build/test -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON "$@"
cmake --build build/test
ctest --test-dir build/test --output-on-failure -j "$(nproc)"
