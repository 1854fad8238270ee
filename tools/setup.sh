#!/usr/bin/env bash
# Installs what building and testing spectile needs on Debian 12; does nothing, and needs no root, where all is there.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libxsimd-dev libtbb-dev libopenexr-dev libimath-dev libdeflate-dev libpugixml-dev libxxhash-dev libfmt-dev
  libeigen3-dev libcli11-dev nlohmann-json3-dev
  libgtest-dev libgmock-dev librapidcheck-dev python3
)

if ! command -v dpkg-query >/dev/null; then
  echo "setup: this is not Debian; install by hand what these packages hold: ${packages[*]}" >&2
  exit 0
fi

# For two tests alone, which are skipped without them: job arrays, and how the benchmark's page looks. They bring services
# and much else along, so that they are installed only where nobody works, or on request (SPECTILE_SETUP_SLURM=yes,
# SPECTILE_SETUP_CHROMIUM=yes); setting up does not fail without them.
optional=()
if [ "${CI:-}" = true ] || [ "${SPECTILE_SETUP_SLURM:-}" = yes ]; then
  optional+=(munge slurmctld slurmd slurm-client)
fi
if [ "${CI:-}" = true ] || [ "${SPECTILE_SETUP_CHROMIUM:-}" = yes ]; then
  optional+=(chromium)
fi

installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null || true)" = installed ]; }
missing=()
for package in "${packages[@]}"; do installed "$package" || missing+=("$package"); done
missing_optional=()
for package in "${optional[@]}"; do installed "$package" || missing_optional+=("$package"); done
if [ ${#missing[@]} -eq 0 ] && [ ${#missing_optional[@]} -eq 0 ]; then
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    [ ${#missing[@]} -eq 0 ] && exit 0
    echo "setup: missing packages: ${missing[*]}; as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
install() {
  echo "setup: installing these Debian packages with apt-get: $*"
  "${as_root[@]}" apt-get update -qq && "${as_root[@]}" apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}
if [ ${#missing[@]} -gt 0 ]; then
  install "${missing[@]}"
fi
if [ ${#missing_optional[@]} -gt 0 ]; then
  install "${missing_optional[@]}" || echo "setup: going on without ${missing_optional[*]}"
fi
