#!/usr/bin/env bash
# Installs the built package into a new folder and builds and runs a consumer that finds it there.
# usage: run.sh CMAKE BUILD_FOLDER CONSUMER_SOURCE
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" --install "$2" --prefix "$work/prefix" >/dev/null
"$1" -S "$3" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" ${CONSUMER_FLAGS:+"-DCMAKE_CXX_FLAGS=$CONSUMER_FLAGS"} >/dev/null
"$1" --build "$work/build" >/dev/null
"$work/build/consumer"
"$work/prefix/bin/spectile" --version
