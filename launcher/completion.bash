# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Completes smoothfem's command line in bash. The program provides commands, options and names.

_smoothfem() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} words=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    words="$("$program" complete commands 2>/dev/null) --help --version"
  elif [[ $word == -* ]]; then
    words=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE '^  (-[a-z],)?--?[a-z][a-z-]*' | tr -d ' ' | tr ',' '\n')
  else
    case $previous in
      -m|--method) words=$("$program" complete methods 2>/dev/null) ;;
      --preset) words=$("$program" complete presets 2>/dev/null) ;;
      --elements) words='triangles quadrilaterals mixed tetrahedra hexahedra' ;;
      --scale) words='quick paper' ;;
      --format) words='pdf png svg' ;;
      --methods) words=$("$program" complete methods 2>/dev/null) ;;
      list) words="methods presets studies domains solutions metrics formats $("$program" complete methods 2>/dev/null)" ;;
      --study-keys) words='smoothing collection polygons regularization' ;;
      study) words="$("$program" complete studies 2>/dev/null) all" ;;
      generate) words=$("$program" generate --list 2>/dev/null | sed 's/ .*//') ;;
    esac
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  # All other words are files or folders.
  [[ -z $words || $previous == study ]] && mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$word")
}

complete -o filenames -F _smoothfem smoothfem
