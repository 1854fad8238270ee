#!/usr/bin/env bash
# The kernels' objects define nothing that another unit could link to, but for their tables, and use nothing of the
# C++ runtime. usage: kernel_symbols.sh NM OBJECT...
set -uo pipefail
nm=$1
shift
bad=0
for object in "$@"; do
  # Defined: anything global or weak that is not the table, nor a constant that is the same in every unit.
  defined=$("$nm" -C --defined-only "$object" | awk '$2 ~ /[A-Zuvw]/ { $1=""; $2=""; print }' |
    grep -vE '^ *spectile::kernels::(sse42|avx2|avx512|neon|k(Exp|Atanh)Series)$|__odr_asan\.' || true)
  # Undefined: only memory functions, the stack protector and sanitizers.
  undefined=$("$nm" --undefined-only "$object" | awk '{ print $NF }' |
    grep -vE '^(memcpy|memset|memmove|__stack_chk_fail|_GLOBAL_OFFSET_TABLE_|__(asan|ubsan|tsan|sanitizer)_.*)$' || true)
  tables=$("$nm" -C --defined-only "$object" | grep -cE 'spectile::kernels::(sse42|avx2|avx512|neon)$' || true)
  [ -z "$defined" ] || { echo "$object defines for others:"$'\n'"$defined"; bad=1; }
  [ -z "$undefined" ] || { echo "$object needs from others:"$'\n'"$undefined"; bad=1; }
  [ "$tables" -eq 1 ] || { echo "$object has $tables tables"; bad=1; }
done
exit $bad
