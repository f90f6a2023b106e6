#!/usr/bin/env bash
# Installs what the library, its tools and its tests are built with, on Debian 12, Ubuntu 22.04 and later.
# Further package names may be given as arguments.
set -euo pipefail

packages=(build-essential cmake ninja-build libpcl-dev libceres-dev libeigen3-dev libflann-dev liblz4-dev
          libsqlite3-dev libpcap-dev libzstd-dev libbz2-dev libtinyxml2-dev libyaml-cpp-dev libgtest-dev libbenchmark-dev
          libcli11-dev nlohmann-json3-dev libembree-dev gnuplot-nox python3 "$@")

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
