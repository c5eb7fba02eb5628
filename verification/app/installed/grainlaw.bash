# Completion of grainlaw's commands, their options and the files that they take, for bash.
_grainlaw() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
  local commands options
  # What the program itself says that it knows: lines of its help that begin with a name.
  if ((COMP_CWORD == 1)); then
    commands=$("${COMP_WORDS[0]}" --help 2>/dev/null | sed -n '/^Subcommands:/,$ s/^  \([a-z]*\) .*/\1/p')
    mapfile -t COMPREPLY < <(compgen -W "$commands --help --version" -- "$word")
    return
  fi
  case $before in
    --format) mapfile -t COMPREPLY < <(compgen -W "yade lammps dump" -- "$word"); return ;;
    --dimension) mapfile -t COMPREPLY < <(compgen -W "2 3" -- "$word"); return ;;
    --output) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$word"); return ;;
  esac
  if [[ $word == -* ]]; then
    options=$("${COMP_WORDS[0]}" "$command" --help 2>/dev/null | grep -o -- '^  \(-[a-z],\)\?--[a-z-]*' | sed 's/.*--/--/')
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
    return
  fi
  compopt -o filenames
  case $command in
    point | solve | dns | wave | pack | export | choose)
      mapfile -t COMPREPLY < <(compgen -f -X '!*.toml' -- "$word"; compgen -d -- "$word") ;;
    *) mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
  esac
}
complete -F _grainlaw grainlaw
