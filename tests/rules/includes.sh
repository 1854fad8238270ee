#!/usr/bin/env bash
# Includes go down only, and each outside library has one room. usage: includes.sh PROJECT_FOLDER
set -uo pipefail
cd "$1" || exit 2
bad=0
complain() { echo "$1"; bad=1; }

# --- one dependency a room: PATTERN, what it is, the only places that may include it --------------------------------
only_in() {
  local pattern=$1 what=$2 allowed=$3
  local hits
  hits=$(grep -rnE "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($pattern)" include kernels src | grep -vE "^($allowed)" || true)
  [ -z "$hits" ] || complain "$what outside its room:"$'\n'"$hits"
}
only_in 'xsimd' 'xsimd' 'kernels/simd\.hpp'
only_in '[a-z]*mmintrin\.h|immintrin\.h|arm_neon\.h' 'intrinsics' 'kernels/simd\.hpp'
only_in '(oneapi/)?tbb' 'oneTBB' 'src/ops/tiles\.cpp'
only_in 'OpenEXR|Imf|Imath' 'OpenEXR' 'src/io/'
only_in 'libdeflate' 'libdeflate' 'src/io/zip_encoder\.cpp'
only_in 'Eigen' 'Eigen' 'src/ops/(quadratic_program|plan_[a-z]+)\.[ch]pp'
only_in 'CLI/' 'CLI11' 'src/cli/'
only_in 'nlohmann' 'nlohmann-json' 'src/cli/|src/io/plan_json\.cpp|src/measure/report_json\.cpp'
only_in 'fmt/' 'fmt' 'src/'

# --- rooms, from the ground up: each may include the rooms named -----------------------------------------------------
may_include() {
  local room=$1 allowed=$2
  local hits
  hits=$(grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' "$room" | grep -vE "include[[:space:]]*\"($allowed)" || true)
  [ -z "$hits" ] || complain "$room includes from above:"$'\n'"$hits"
}
may_include include/spectile 'nothing'
may_include kernels 'kernels/'
may_include src/base 'src/base/'
may_include src/data 'src/data/'
may_include src/model 'src/(base|model|data)/'
may_include src/reference 'kernels/(abi|exponential_constants|sigmoid_constants)\.hpp|src/(base|model|data|reference)/'
may_include src/dispatch 'kernels/abi\.hpp|src/(base|model|data|reference|dispatch)/'
may_include src/ops 'kernels/abi\.hpp|src/(base|model|data|reference|dispatch|ops)/'
may_include src/io 'kernels/abi\.hpp|src/(base|model|data|reference|dispatch|ops|io)/'
may_include src/measure 'kernels/(abi|exponential_constants|sigmoid_constants)\.hpp|src/(base|model|data|reference|dispatch|ops|measure)/'
may_include src/cli 'src/cli/'

# --- the kernels' units hold raw-pointer code only: no containers, no algorithms -------------------------------------
hits=$(grep -nE '^[[:space:]]*#[[:space:]]*include[[:space:]]*<' kernels/*.inl kernels/*.hpp kernels/*.cpp |
  grep -vE '<(cstddef|cstdint|cstring|cmath|xsimd/xsimd\.hpp|immintrin\.h|arm_neon\.h)>' || true)
[ -z "$hits" ] || complain "kernels include more than raw-pointer code needs:"$'\n'"$hits"

# --- the library neither prints nor exits ------------------------------------------------------------------------------
hits=$(grep -rnE '\b(printf|fprintf|puts|std::cout|std::cerr|fmt::print|std::exit|std::abort|abort|exit)\(' \
  include kernels src --include=*.hpp --include=*.cpp --include=*.inl | grep -v '^src/cli/' || true)
[ -z "$hits" ] || complain "the library prints or exits:"$'\n'"$hits"

exit $bad
