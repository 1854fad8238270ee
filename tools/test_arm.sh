#!/usr/bin/env bash
# Cross-compiles for 64-bit Arm and runs there, under an emulator, the tests of all kernels, the stress rows and a handful of
# conversions, whose bytes must be those of this machine. Debian; needs build/spectile (tools/test.sh). Nothing of Arm is
# installed: its libraries are unpacked into build-arm/root. usage: tools/test_arm.sh
set -euo pipefail
cd "$(dirname "$0")/.."
here=$PWD
out=$here/build-arm
root=$out/root
[ -x build/spectile ] || { echo "test_arm: build/spectile is missing; tools/test.sh builds it" >&2; exit 2; }

missing=()
command -v aarch64-linux-gnu-g++ >/dev/null || missing+=(g++-aarch64-linux-gnu)
command -v qemu-aarch64 >/dev/null || missing+=(qemu-user)
if [ ${#missing[@]} -gt 0 ]; then
  echo "test_arm: installing ${missing[*]}"
  as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

# --- Arm's libraries, by this machine's sources of packages
if [ ! -e "$root/complete" ]; then
  state=$out/apt
  mkdir -p "$state/lists/partial" "$state/archives/partial" "$root"
  : >"$state/status"
  cat >"$state/apt.conf" <<EOF
APT::Architecture "arm64";
APT::Architectures {"arm64";};
Dir::State "$state";
Dir::State::status "$state/status";
Dir::Cache "$state";
Acquire::Languages "none";
APT::Sandbox::User "";
EOF
  export APT_CONFIG=$state/apt.conf
  # What tools/setup.sh lists, without its programs.
  libraries=$(sed -n '/^packages=(/,/^)/p' tools/setup.sh | grep -oE 'lib[a-z0-9+.-]*|[a-z0-9-]*-dev')
  apt-get update -qq
  # shellcheck disable=SC2086
  apt-get install -y -qq --no-install-recommends --download-only $libraries libstdc++6 libc6 >/dev/null
  unset APT_CONFIG
  for package in "$state"/archives/*.deb; do dpkg -x "$package" "$root"; done
  touch "$root/complete"
fi

# --- build
cmake -S . -B "$out" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSPECTILE_ARM_ROOT="$root" \
  -DCMAKE_TOOLCHAIN_FILE="$here/cmake/toolchains/aarch64-linux-gnu.cmake" >/dev/null
cmake --build "$out" --target spectile_tool spectile_core_tests

# --- run
arm() { qemu-aarch64 -L "$root" "$@"; }
status=0
echo "== tests of the kernels"
arm "$out/tests/spectile_core_tests" --gtest_brief=1 \
  --gtest_filter='*Kernels*:Half.*:KernelState.*:Reference*:*FilmSums*:Arithmetic*' | grep -v 'does not run on\|Skipped$' || status=1
echo "== stress rows"
arm "$out/spectile" bench --quick --stress-only --isa neon || status=1

echo "== conversions"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
build/spectile demo "$work/demo" --quiet
chart=$work/demo/chart.exr
same=0
compare() {  # NAME COMMAND...: the command's output file is OUT
  local name=$1 machine
  shift
  for machine in x86 arm; do
    local run=(build/spectile)
    [ $machine = arm ] && run=(qemu-aarch64 -L "$root" "$out/spectile")
    "${run[@]}" "${@//OUT/$work/$machine-$name}" --quiet
  done
  if cmp "$work/x86-$name" "$work/arm-$name"; then
    same=$((same + 1))
  else
    status=1
  fi
}
small=$work/small.exr
build/spectile upsample "$chart" --region 0,0,255,127 --method sigmoid -o "$small" --quiet
compare default.exr upsample "$chart" --region 0,0,255,127 -o OUT
compare exact.exr upsample "$chart" --region 0,0,255,127 --method smits-exact -o OUT
compare sigmoid.exr upsample "$chart" --region 0,0,255,127 --method sigmoid -o OUT
compare mallett.exr upsample "$chart" --region 0,0,255,127 --method mallett --depth float -o OUT
compare tiles.exr upsample "$chart" --region 0,0,255,127 --tile 64 64 --mipmap -o OUT
compare project.exr project "$small" --illuminant FL11 --depth float -o OUT
compare relight.exr relight "$chart" --region 0,0,255,127 --illuminant A -o OUT
compare convert.exr convert "$small" --bands 400:700:10 -o OUT
compare film.exr film simulate --size 48 48 --samples 4 -o OUT
compare picture.exr film develop "$work/x86-film.exr" --depth float -o OUT
echo "conversions with x86's bytes: $same of 10"
exit $status
