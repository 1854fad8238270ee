#!/usr/bin/env bash
# Builds spectile and runs its main job on a built-in chart. usage: tools/demo.sh [DIR]
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build build --target spectile_tool
exec build/spectile demo "${1:-build/demo}"
