# SPDX-License-Identifier: MIT
# shellcheck shell=bash disable=SC2154 # root is set by those who source this
# Configuring and building a preset, for scripts/mc and scripts/test. Needs `root`, the source tree.

# Runs a command silently; if it fails, shows the end of what it said on stderr.
mc_quietly() {
  local log status=0
  log=$(mktemp)
  "$@" </dev/null >"$log" 2>&1 || status=$?
  ((status == 0)) || tail -n 200 "$log" >&2
  rm -f "$log"
  return "$status"
}

# Whether the preset must be configured: never done, done for a tree at another place (a copied
# folder), or done before packages came that it looked for in vain.
mc_must_configure() {
  local cache=$root/build/$1/CMakeCache.txt
  [[ $MC_PACKAGES_INSTALLED == no && -f $root/build/$1/build.ninja ]] || return 0
  ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache"
}

# Brings a target of a preset up to date: mc_build PRESET TARGET. One at a time: others wait.
mc_build() {
  mkdir -p "$root/build"
  (
    flock 9
    cd "$root" || exit
    if mc_must_configure "$1"; then
      echo "mc: configuring and building $1, once" >&2
      mc_quietly cmake --fresh --preset "$1" || exit
    fi
    mc_quietly cmake --build "build/$1" --target "$2"
  ) 9>"$root/build/.lock-$1"
}
