#!/usr/bin/env bash
# Time and size of every compression on spectral planes, as a table in Markdown.
# usage: bench/compression_table.sh IMAGE.exr [RUNS [THREADS]]   (default 3 runs, 1 thread)
set -euo pipefail
image=$(realpath "$1") runs=${2:-3} threads=${3:-1}
cd "$(dirname "$0")/.."
work=$(mktemp -d "${TMPDIR:-/tmp}/spectile-bench.XXXXXX")
trap 'rm -rf "$work"' EXIT
field() { sed -E "s/.*\"$1\":([0-9.e+-]+).*/\1/"; }
methods="none rle zips:1 zips:4 zip:1 zip:2 zip:3 zip:4 zip:5 zip:6 zip:9 piz pxr24 b44 b44a dwaa dwab"
# Runs go round the methods, so that other load on the machine meets all alike; a method's figure is its median.
for run in $(seq "$runs"); do
  for method in $methods; do
    build/spectile upsample "$image" -o "$work/out.exr" --compression "$method" --threads "$threads" --json --nonfinite zero >"$work/json"
    echo "$method $(field seconds <"$work/json") $(field bytes_written <"$work/json") $(field width <"$work/json") $(field height <"$work/json")" >>"$work/all"
    rm "$work/out.exr"
  done
done
echo "| compression | Mpixel/s | bytes/pixel | size against none |"
echo "|---|---:|---:|---:|"
none=$(awk '$1 == "none" { print $3; exit }' "$work/all")
for method in $methods; do
  awk -v m="$method" '$1 == m' "$work/all" | sort -k2 -g | awk -v none="$none" '
    { line[NR] = $0 }
    END { split(line[int((NR + 1) / 2)], f, " "); printf "| `%s` | %.2f | %.1f | %.0f %% |\n", f[1], f[4] * f[5] / f[2] / 1e6, f[3] / f[4] / f[5], 100 * f[3] / none }'
done
