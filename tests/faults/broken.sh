#!/bin/sh
# Stands in for the tool, and does wrong what the checks must notice: SPECTILE_BROKEN says what. Where the tool succeeds
# it does nothing wrong, so that runs without a fault are as always.
"$SPECTILE_REAL" "$@" 2>errors.tmp
code=$?
errors=$(cat errors.tmp)
rm -f errors.tmp
if [ "$code" -ne 0 ]; then
  case "$SPECTILE_BROKEN" in
    wrong) exit 0 ;;
    torn) printf 'half a file' >out.exr ;;
    input) printf 'changed' >in.exr ;;
    leftover) : >.spectile-0123456789abcdef.part ;;
    code) code=7 ;;
    silent) exit "$code" ;;
    words) errors="$errors (std::bad_alloc)" ;;
    reason) errors="spectile: out.exr: cannot write" ;;
    file) errors="spectile: other.exr: cannot write: No space left on device" ;;
    crash) kill -ABRT $$ ;;
    hang) exec sleep 60 ;;
  esac
fi
[ -z "$errors" ] || printf '%s\n' "$errors" >&2
exit "$code"
