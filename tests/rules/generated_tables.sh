#!/usr/bin/env bash
# The tables of src/data that this project computes are what its program writes, and the comparison notices when they
# are not. usage: generated_tables.sh PROGRAM PROJECT_FOLDER
set -uo pipefail
program=$1
root=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Text of a file but for its numbers and its line breaks; its numbers, one a line. Another machine may round the last
# digits of a number otherwise, and so break lines elsewhere.
number='-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?'
text_of() { sed -E "/^ /s/$number/#/g" "$1" | tr -d ' \n'; }
numbers_of() { grep -E '^ ' "$1" | grep -oE -- "$number"; }

# same STORED WRITTEN ABSOLUTE RELATIVE: the largest difference is within ABSOLUTE + RELATIVE of the stored number.
same() {
  if [ "$(text_of "$1")" != "$(text_of "$2")" ]; then
    echo "$1 has other text, or another count of numbers, than the program writes"
    return 1
  fi
  paste <(numbers_of "$1") <(numbers_of "$2") | awk -v name="$1" -v absolute="$3" -v relative="$4" '
    { difference = $1 > $2 ? $1 - $2 : $2 - $1
      size = $1 < 0 ? -$1 : $1
      if (NF != 2 || difference > absolute + relative * size) {
        printf "%s: number %d is %s, the program writes %s\n", name, NR, $1, $2
        bad = 1
        exit
      } }
    END { exit bad || NR < 100 }'
}

"$program" "$work" || { echo "$program failed"; exit 1; }
bad=0
same "$root/src/data/exact_bases.cpp" "$work/exact_bases.cpp" 1e-6 0 || bad=1
# Six digits are stored: one in the last of them, at most 1e-5, is rounding.
same "$root/src/data/sigmoid_start.cpp" "$work/sigmoid_start.cpp" 1e-6 1e-5 || bad=1

# Each goes red for a number that is 1e-4 off, and for one that is missing.
for file in exact_bases sigmoid_start; do
  awk '!done && /^ .*0\.[0-9]/ { match($0, /0\.[0-9]+/)
         $0 = substr($0, 1, RSTART - 1) (substr($0, RSTART, RLENGTH) + 2e-4) substr($0, RSTART + RLENGTH)
         done = 1 }
       { print }' "$work/$file.cpp" >"$work/off.cpp"
  sed -E "0,/^ /s/^( *\{?)$number, /\1/" "$work/$file.cpp" >"$work/short.cpp"
  for other in off short; do
    if same "$work/$file.cpp" "$work/$other.cpp" 1e-6 1e-5 >/dev/null; then
      echo "not noticed: $file.cpp is $other"
      bad=1
    fi
  done
done
exit $bad
