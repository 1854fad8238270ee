#!/usr/bin/env bash
# Builds the fuzz targets with clang's sanitizers and runs them, one after the other, from the corpus in the repository;
# what they find on the way is kept in build-fuzz/corpus. usage: tools/fuzz.sh [SECONDS] [TARGET...]
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=60
if [[ ${1:-} =~ ^[0-9]+$ ]]; then
  seconds=$1
  shift
fi
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz ${JOBS:+-j "$JOBS"}
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  targets=(channel_names channel_map option_text plan_json spectrum_text exr_read exr_convert film_file)
fi
export ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=1
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0
status=0
for target in "${targets[@]}"; do
  seeds=$target
  most_bytes=4096
  case $target in
    channel_names | option_text) most_bytes=128 ;;
    exr_*) seeds=exr most_bytes=8192 ;;
    film_file) most_bytes=65536 ;;
  esac
  words=()
  if [ -f "fuzz/$seeds.dict" ]; then words=("-dict=fuzz/$seeds.dict"); fi
  mkdir -p "build-fuzz/corpus/$target" build-fuzz/findings
  echo "== $target, $seconds s"
  log=build-fuzz/findings/$target.log
  # 2 GiB in all, 1 GiB in one piece, 120 s a case: far above what any case takes, unoptimised and checked.
  if "build-fuzz/fuzz/spectile_fuzz_$target" -max_total_time="$seconds" -rss_limit_mb=2048 -malloc_limit_mb=1024 \
    -timeout=120 -max_len=$most_bytes -print_final_stats=1 -artifact_prefix="build-fuzz/findings/$target-" \
    "${words[@]}" "build-fuzz/corpus/$target" "fuzz/corpus/$seeds" >"$log" 2>&1; then
    grep -E 'stat::(number_of_executed_units|average_exec_per_sec|peak_rss_mb)' "$log"
  else
    status=1
    grep -E 'ERROR|SUMMARY|does not hold|runtime error|Test unit written' "$log" || tail -5 "$log"
  fi
done
exit $status
