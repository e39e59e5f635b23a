# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Functions of ./run and the scripts in tools/commands. The caller sets root.
build=$root/build/release

say() { printf '%s\n' "$*" >&2; }
fail() { say "run: $*"; exit 1; }

# Prints the names in the given sections of packages.txt, without comments.
packages() {
  local section
  for section in "$@"; do
    sed -n "/^\[$section\]/,/^\[/p" "$root/packages.txt" | sed -e '/^\[/d' -e 's/#.*//' -e '/^[[:space:]]*$/d' -e 's/[[:space:]]*$//'
  done
}

install_packages() {
  local installed missing=() needed package
  mapfile -t needed < <(packages "$@")
  installed=$(dpkg-query -W -f '${Package} ${Status}\n' "${needed[@]}" 2>/dev/null |
              sed -n 's/ install ok installed$//p') || true
  for package in "${needed[@]}"; do
    grep -qx "$package" <<<"$installed" || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  say "Installing ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "as root, install: ${missing[*]}"
    as_root=(sudo)
  fi
  local log; log=$(mktemp)
  { "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
      "${missing[@]}"; } >"$log" 2>&1 || { tail -n 20 "$log" >&2; fail "could not install packages; the log is $log"; }
  rm -f "$log"
}

# quietly NAME COMMAND...: runs a command, and prints its log only if it fails.
quietly() {
  local log=$build/$1.log; shift
  mkdir -p "$build"
  "$@" >"$log" 2>&1 || { grep -E -A 8 'error|Error|FAILED' "$log" >&2 || tail -n 30 "$log" >&2
                         fail "the build failed; the whole log is $log"; }
}

# Configures once. Later, the build detects changes of a CMakeLists.txt. In CI, warnings are errors, and ccache is not
# used.
configure() {
  [ -f "$build/build.ninja" ] && [ -z "${CI:-}" ] && return
  local options=()
  [ -n "${CI:-}" ] && options+=(-DSMOOTHFEM_WARNINGS_AS_ERRORS=ON -DSMOOTHFEM_CCACHE=OFF)
  quietly configure cmake -S "$root" --preset release \
    -DSMOOTHFEM_PYTHON="$("$root/launcher/find_python")" "${options[@]}"
}

build() {
  install_packages build
  [ -x "$build/libexec/smoothfem/smoothfem" ] || say "Building (a few minutes the first time)"
  configure
  quietly build cmake --build "$build" "$@"
}

# Replaces this shell by a script that reads results with the package plots.
with_plots() {
  local python
  python=$("$root/launcher/find_python")
  PYTHONPATH=$root exec "$python" -B "$@"
}
