# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Completion of smoothfem's command line in bash. Commands, options and names are asked of the program.

# The first words of the lines that follow a heading of `smoothfem list`, up to the next one.
_smoothfem_listed() {
  "$1" list 2>/dev/null | sed -n "/^$2/,/^[^ ]/s/^  \([^ :][^ :]*\).*/\1/p"
}

_smoothfem() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} words=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    words="$("$program" --help 2>/dev/null | sed -n '/^Subcommands/,$s/^  \([a-z][a-z-]*\) .*/\1/p') plot report --help --version"
  elif [[ $word == -* ]]; then
    words=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE '^  (-[a-z],)?--?[a-z][a-z-]*' | tr -d ' ' | tr ',' '\n')
  else
    case $previous in
      -m|--method) words=$(_smoothfem_listed "$program" METHODS) ;;
      --preset) words=$(_smoothfem_listed "$program" PRESETS) ;;
      --elements) words='triangles quadrilaterals mixed tetrahedra hexahedra' ;;
      --scale) words='quick paper' ;;
      --format) words='pdf png svg' ;;
      --methods) words=$(_smoothfem_listed "$program" METHODS) ;;
      study) words="$("$program" study --list 2>/dev/null | sed -n 's/^\([^ ][^ ]*\) .*/\1/p') all" ;;
      generate) words=$(_smoothfem_listed "$program" DOMAINS) ;;
    esac
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  # Anything else is a file or a folder.
  [[ -z $words || $previous == study ]] && mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$word")
}

complete -o filenames -F _smoothfem smoothfem
