#!/bin/sh
# Stands in for the tool, and does wrong what the checks must notice where it is stopped: SPECTILE_BROKEN says what.
if [ "$SPECTILE_BROKEN" = silent ]; then
  exec 2>/dev/null
fi
"$SPECTILE_REAL" "$@" &
child=$!
stop() {
  kill -TERM "$child"
  wait "$child"
  : >../stopped
  case "$SPECTILE_BROKEN" in
    torn) printf 'half a film' >film.exr ;;
    leftover) : >.spectile-0123456789abcdef.part ;;
    code) exit 5 ;;
    slow) sleep 1.5 ;;
    crash) kill -ABRT $$ ;;
  esac
  exit 143
}
trap stop TERM
wait "$child"
code=$?
if [ "$SPECTILE_BROKEN" = again ] && [ -e ../stopped ]; then
  printf 'another film' >film.exr
fi
exit "$code"
