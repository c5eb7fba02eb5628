# Sourced by the scripts that make pages: what they look up in the tables of $results. Needs bash and Python.

have() { [[ -f $results/$1 ]]; }

# `table FILE [COLUMN...] [-- COLUMN=VALUE...]`, `value FILE COLUMN COLUMN=VALUE...`: see look_up.
table() { ./look_up table "$results/$1" "${@:2}"; }
value() { ./look_up value "$results/$1" "${@:2}"; }

# `numbers FILE PATTERN`: facts whose name has the pattern.
numbers() { printf '\n| fact | value |\n|---|---|\n' && awk -F, -v p="$2" 'NR > 1 && $1 ~ p { print "| " $1 " | " $2 " |" }' "$results/$1"; }
