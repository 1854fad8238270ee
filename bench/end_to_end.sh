#!/usr/bin/env bash
# Measures `spectile upsample` of a large texture against what OpenEXR alone takes to write the same planes.
# usage: bench/end_to_end.sh [SIZE [RUNS [THREADS [IMAGE]]]]   (default 4096 3 2, a procedural texture)
set -euo pipefail
cd "$(dirname "$0")/.."
size=${1:-4096} runs=${2:-3} threads=${3:-2} image=${4:-}
cmake --preset release >/dev/null
cmake --build build --target spectile_tool spectile_bench_end_to_end
work=$(mktemp -d "${TMPDIR:-/tmp}/spectile-bench.XXXXXX")
trap 'rm -rf "$work"' EXIT
build/bench/spectile_bench_end_to_end build/spectile "$work" "$size" "$runs" "$threads" ${image:+"$image"}
