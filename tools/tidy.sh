#!/usr/bin/env bash
# Runs clang-tidy over the library and the tool. usage: tools/tidy.sh [FILE...]
set -euo pipefail
cd "$(dirname "$0")/.."
# Without units of several files, which have no compile command a file.
cmake -S . -B build-tidy -G Ninja -DCMAKE_BUILD_TYPE=Release -DSPECTILE_UNITY=OFF -DSPECTILE_PRECOMPILE=OFF >/dev/null
files=("$@")
if [ ${#files[@]} -eq 0 ]; then
  mapfile -t files < <(git ls-files 'src/*.cpp' | grep -v '^src/data/')
fi
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build-tidy --quiet --extra-arg=-Wno-unknown-warning-option
