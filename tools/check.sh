#!/usr/bin/env bash
# Builds with clang's sanitizers and runs the whole suite: asan finds errors in memory and undefined behaviour, tsan data
# races. An hour on two cores. usage: tools/check.sh asan|tsan [CTEST OPTIONS], such as -LE slow
set -euo pipefail
cd "$(dirname "$0")/.."
which=${1:-}
case $which in
  asan | tsan) shift ;;
  *) echo "usage: tools/check.sh asan|tsan [CTEST OPTIONS]" >&2; exit 2 ;;
esac
command -v clang++ >/dev/null || { echo "check: clang++ is missing (Debian: apt-get install clang)" >&2; exit 2; }
cmake --preset "$which" >/dev/null
cmake --build --preset "$which" ${JOBS:+-j "$JOBS"}
echo "check: $which on $(git describe --always --dirty), $(date +%F)"
ctest --preset "$which" -j "${JOBS:-$(nproc)}" "$@"
