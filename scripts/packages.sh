# SPDX-License-Identifier: MIT
# shellcheck shell=bash disable=SC2034 # the lists are for those who source this
# The one list of the distribution's packages that mc needs, and how to install what is missing of
# them. Sourced by scripts/mc, scripts/test, scripts/check, scripts/bench and scripts/pictures; known
# to hold for Debian 12.
#
# An entry is PACKAGE, or PACKAGE:COMMAND where any COMMAND on the PATH will do as well (a compiler
# or an npm that came from elsewhere).

mc_build_packages=(
  g++:g++ cmake:cmake ninja-build:ninja ccache:ccache
  libopenvdb-dev libboost-iostreams-dev zlib1g-dev # the last two: OpenVDB's find module wants them
  libblosc-dev libdeflate-dev # what packs VDB files
  libopenexr-dev libpng-dev
  libzstd-dev # with zlib: packed inputs
  libtbb-dev libtinygltf-dev nlohmann-json3-dev libcli11-dev libfmt-dev libhwy-dev
  libgtest-dev # the presets configure the tests as well
)

mc_test_packages=(
  python3:python3 clang-format-14
  assimp-utils:assimp python3-vtk9 # two readers that know nothing of ours
  python3-scipy                    # labels components on its own
  python3-jsonschema               # the schema of mc-volume
  zsh:zsh fish:fish                # what completes in them
  npm:npm                          # for the Khronos glTF validator
)

mc_check_packages=(
  clang:clang++ clang-tidy-14 libclang-rt-14-dev pandoc:pandoc shellcheck:shellcheck
  xz-utils:xz # for what fuzzers found
)

mc_bench_packages=(
  python3:python3 libbenchmark-dev
  libvtk9-dev # a peer, 0.5 GB with what it needs; the other, OpenVDB, is there already
)

mc_picture_packages=(python3-vtk9 xvfb:xvfb-run)

# Prints those of the given entries whose package is not installed.
mc_missing_packages() {
  local entry name
  local -a names=() missing=()
  for entry in "$@"; do
    if [[ $entry != *:* ]] || ! command -v "${entry#*:}" >/dev/null; then
      names+=("${entry%%:*}")
    fi
  done
  ((${#names[@]})) || return 0
  local installed
  # shellcheck disable=SC2016 # the ${} are dpkg-query's
  installed=" $(dpkg-query -W -f '${db:Status-Status}=${Package} ' "${names[@]}" 2>/dev/null) "
  for name in "${names[@]}"; do
    [[ $installed == *" installed=$name "* ]] || missing+=("$name")
  done
  echo "${missing[*]}"
}

# Installs what is missing of the given entries. Everything it says goes to stderr, and stdin is
# left alone. Returns 0 when all is there, 2 when the user has to install something first.
# MC_PACKAGES_INSTALLED tells the caller whether anything was installed.
mc_install_packages() {
  MC_PACKAGES_INSTALLED=no
  command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || return 0 # not Debian's kind
  local missing
  missing=$(mc_missing_packages "$@")
  [[ $missing ]] || return 0
  if ((EUID != 0)); then
    echo "sudo apt-get install -y --no-install-recommends $missing" >&2
    return 2
  fi
  echo "mc: installing $missing" >&2
  local log status=0
  log=$(mktemp)
  # shellcheck disable=SC2086 # one word a package
  mc_apt_install $missing >"$log" 2>&1 </dev/null || status=2
  if ((status != 0)); then
    tail -n 40 "$log" >&2
    echo "mc: error: packages: cannot install $missing: see apt-get's messages above" >&2
  fi
  rm -f "$log"
  MC_PACKAGES_INSTALLED=yes
  return "$status"
}

# Installs packages. Where the lists are missing (fresh containers) or too old to find what they
# name, they are fetched first; whether that worked, the installation shows.
mc_apt_install() {
  if compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null &&
    mc_apt_get install --no-install-recommends "$@"; then
    return 0
  fi
  mc_apt_get update
  mc_apt_get install --no-install-recommends "$@"
}

# apt-get without questions and without a terminal, waiting for another apt-get.
mc_apt_get() {
  DEBIAN_FRONTEND=noninteractive apt-get -y -qq -o DPkg::Lock::Timeout=900 -o Dpkg::Use-Pty=0 \
    -o Acquire::Retries=3 "$@"
}
