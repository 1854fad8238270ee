#!/usr/bin/env bash
# Each rule of includes.sh goes red when it is broken. usage: includes_can_fail.sh PROJECT_FOLDER
set -euo pipefail
root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$(cd "$(dirname "$0")" && pwd)
try() {
  local file=$1 line=$2
  rm -rf "$work/copy"
  mkdir "$work/copy"
  cp -r "$root/include" "$root/kernels" "$root/src" "$work/copy"
  echo "$line" >>"$work/copy/$file"
  if "$here/includes.sh" "$work/copy" >/dev/null; then
    echo "not noticed: $line in $file"
    exit 1
  fi
}
try src/ops/upsample.cpp '#include <xsimd/xsimd.hpp>'
try src/ops/upsample.cpp '#include <tbb/parallel_for.h>'
try src/ops/upsample.cpp '#include <OpenEXR/ImfHeader.h>'
try src/ops/upsample.cpp '#include "src/io/exr/strips.hpp"'
try src/cli/main.cpp '#include "src/lanes/tiles.hpp"'
try include/spectile/bands.hpp '#include <fmt/format.h>'
try include/spectile/bands.hpp '#include "src/base/errors.hpp"'
try kernels/convert.inl '#include <vector>'
try src/io/film_file.cpp '#include <nlohmann/json.hpp>'
try src/io/lines.cpp 'void f() { std::exit(1); }'
