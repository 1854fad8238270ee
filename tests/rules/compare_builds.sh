#!/usr/bin/env bash
# bench/compare.py finds a real loss between two builds, and none in noise. The builds are stand-ins that print figures.
# usage: compare_builds.sh PROJECT_FOLDER
set -uo pipefail
compare=$1/bench/compare.py
command -v python3 >/dev/null || { echo "no python3 here"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0

# A stand-in reaches FRACTION of the limit, off by up to NOISE, another each time.
stand_in() {
  cat >"$work/$1" <<SCRIPT
#!/usr/bin/env python3
import json, random
random.seed()
def off(fraction, noise): return fraction * (1 + random.uniform(-noise, noise))
print(json.dumps({"machine": {"processor": "none"}, "operations": [
    {"isa": "avx2", "name": "add", "fraction": off($2, $3)},
    {"isa": "avx2", "name": "multiply", "fraction": off(0.9, 0.01)}]}))
SCRIPT
  chmod +x "$work/$1"
}
expect() {
  local code=$1 what=$2
  shift 2
  "$compare" "$@" >"$work/out" 2>&1
  local got=$?
  [ "$got" -eq "$code" ] || { echo "$what: exit code $got, not $code"; cat "$work/out"; bad=1; }
}

stand_in same 0.8 0.01
stand_in slower 0.68 0.01
stand_in faster 0.95 0.01
stand_in noisy 0.79 0.4
stand_in little 0.78 0.005
expect 0 "a build and itself" "$work/same" "$work/same" --rounds 9
expect 1 "15 % slower" "$work/same" "$work/slower" --rounds 9
grep -q "add .* LOSS" "$work/out" || { echo "the operation that lost is not named"; bad=1; }
grep -q "multiply .* LOSS" "$work/out" && { echo "an operation that did not lose is named"; bad=1; }
expect 0 "faster" "$work/same" "$work/faster" --rounds 9
expect 0 "noise larger than the difference" "$work/same" "$work/noisy" --rounds 15
expect 0 "less than what counts" "$work/same" "$work/little" --rounds 9
expect 1 "less, where it counts" "$work/same" "$work/little" --rounds 15 --least 0.01
expect 2 "a build that is not there" "$work/same" "$work/nothing" --rounds 9
expect 2 "too few rounds" "$work/same" "$work/same" --rounds 2
expect 0 "a record" "$work/same" "$work/faster" --rounds 5 --record "$work/history.json" --label one
expect 0 "another" "$work/same" "$work/faster" --rounds 5 --record "$work/history.json" --label two
python3 - "$work/history.json" <<'CHECK' || bad=1
import json, sys
entries = json.load(open(sys.argv[1]))["entries"]
assert [e["label"] for e in entries] == ["one", "two"], entries
assert abs(entries[0]["fractions"]["avx2"]["add"] - 0.95) < 0.02, entries
CHECK
exit $bad
