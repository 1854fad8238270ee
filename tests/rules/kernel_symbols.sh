#!/usr/bin/env bash
# Each of the kernels' objects defines one table of its instruction set and nothing else that another unit could link to,
# and uses nothing of the C++ runtime; the unit that lists the tables uses those of its own instruction set alone.
# usage: kernel_symbols.sh NM OBJECT...
set -uo pipefail
nm=$1
shift
bad=0
for object in "$@"; do
  defined=$("$nm" -C --defined-only "$object" | awk '$2 ~ /[A-Zuvw]/ { $1=""; $2=""; print }' | sed 's/^ *//')
  table=$(grep -E '^spectile::kernels::(sse42|avx2|avx512|neon)::[a-z]+$' <<<"$defined" || true)
  # Beside the table: constants that are the same in every unit.
  others=$(grep -vE '^(spectile::kernels::((sse42|avx2|avx512|neon)::[a-z]+|k(Exp|Atanh|Planck)Series)|__odr_asan\..*|)$' \
    <<<"$defined" || true)
  # Undefined: only memory functions, the stack protector, sanitizers, and tables of the same instruction set.
  undefined=$("$nm" -C --undefined-only "$object" | sed 's/^ *[Uuvw] *//' |
    grep -vE '^(memcpy|memset|memmove|__stack_chk_fail|_GLOBAL_OFFSET_TABLE_|__(asan|ubsan|tsan|sanitizer)_.*)$' |
    grep -vE "^${table%::*}::(arithmetic|color|upsampling|wavelengths|film|texture)$" || true)
  # The types that clang's check of calls compares, where an object has that check.
  if "$nm" --undefined-only "$object" | grep -q __ubsan_; then
    others=$(grep -vE '^typeinfo (name )?for .*\(.*\)$' <<<"$others" || true)
    undefined=$(grep -vxF 'vtable for __cxxabiv1::__function_type_info' <<<"$undefined" || true)
  fi
  [ -z "$others" ] || { echo "$object defines for others:"$'\n'"$others"; bad=1; }
  [ -z "$undefined" ] || { echo "$object needs from others:"$'\n'"$undefined"; bad=1; }
  [ "$(grep -c . <<<"$table")" -eq 1 ] || { echo "$object has other than one table: $table"; bad=1; }
done
exit $bad
