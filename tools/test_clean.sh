#!/usr/bin/env bash
# Tries the present commit on a clean Debian, 12 (bookworm) or 13 (trixie): makes a root folder with debootstrap, clones into
# it, runs there the two commands that the README begins with, and the tests. Needs root; takes a quarter of an hour or more on
# two cores. The folder, build-clean/RELEASE, is made anew each time and kept. usage: tools/test_clean.sh [bookworm|trixie]
set -euo pipefail
cd "$(dirname "$0")/.."
release=${1:-bookworm}
case $release in
  bookworm | trixie) ;;
  *) echo "usage: tools/test_clean.sh [bookworm|trixie]" >&2; exit 2 ;;
esac
[ "$(id -u)" -eq 0 ] || { echo "test_clean: only root can make a root folder" >&2; exit 2; }
if ! command -v debootstrap >/dev/null; then
  echo "test_clean: installing debootstrap"
  apt-get update -qq
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends debootstrap >/dev/null
fi
if [ -n "$(git status --porcelain)" ]; then
  echo "test_clean: changes that are not committed are left out"
fi

root=$PWD/build-clean/$release
seconds=$SECONDS
rm -rf --one-file-system "$root"
mkdir -p "$root"
# The archive that this machine has its own packages from.
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | grep '/debian/*$' | head -n 1)
debootstrap --variant=minbase --include=ca-certificates "$release" "$root" "$mirror" >"$root.log" 2>&1 ||
  { tail -n 20 "$root.log" >&2; exit 1; }
git clone -q --no-hardlinks . "$root/root/spectile"
echo "test_clean: $release, $(git log -1 --format='%h of %cs'), root folder made in $((SECONDS - seconds)) s"

# Its processes and mounts end with it.
unshare --mount --pid --fork --kill-child bash -euo pipefail -s "$root" <<'EOS' 2>&1 | tee "$root.log"
mount -t proc proc "$1/proc"
mount --rbind /dev "$1/dev"
mount -t tmpfs tmp "$1/tmp"
exec chroot "$1" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
  ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
  bash -euo pipefail -c '
    cd /root/spectile
    step() {
      local begin=$SECONDS
      echo "test_clean: $*"
      "$@"
      echo "test_clean: $* took $((SECONDS - begin)) s"
    }
    step tools/demo.sh </dev/null
    cp build/demo/chart.exr wood.exr
    step build/spectile upsample wood.exr -o wood-spectral.exr
    step tools/test.sh </dev/null
    echo "test_clean: with these versions"
    g++ -dumpfullversion | sed "s/^/g++ /"
    dpkg-query -W -f "\${Package} \${Version}\n" cmake libxsimd-dev libopenexr-dev libtbb-dev libfmt-dev libeigen3-dev \
      libdeflate-dev libpugixml-dev libxxhash-dev libcli11-dev nlohmann-json3-dev libgtest-dev
  '
EOS
echo "test_clean: $release passed, with $(grep -c 'warning:' "$root.log" || true) warnings of the compiler"
