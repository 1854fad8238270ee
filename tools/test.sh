#!/usr/bin/env bash
# Builds spectile and runs its tests, without the slow ones. usage: tools/test.sh [--all] [CTEST OPTIONS]
set -euo pipefail
cd "$(dirname "$0")/.."
which=(-LE slow)
if [ "${1:-}" = --all ]; then
  which=()
  shift
fi
tools/setup.sh
werror=()
[ "${CI:-}" = true ] && werror=(-DSPECTILE_WERROR=ON)
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release "${werror[@]}" >/dev/null
cmake --build build
log=$(mktemp)
trap 'rm -f "$log"' EXIT
rm -rf build/Testing/counts
status=0
ctest --test-dir build --output-on-failure --no-tests=error -j "$(nproc)" "${which[@]}" "$@" | tee "$log" || status=$?
tools/count_tests.py "$log" build/Testing/counts
exit "$status"
