# Sourced by the scripts that make pages: what they look up in the tables of $results. Needs bash and Python.

have() { [[ -f $results/$1 ]]; }

# `table FILE [COLUMN...] [-- COLUMN=VALUE...]`, `value FILE COLUMN COLUMN=VALUE...`, `facts FILE FIGURE SOURCE`: see look_up.
table() { ./look_up table "$results/$1" "${@:2}"; }
value() { ./look_up value "$results/$1" "${@:2}"; }
facts_of() { ./look_up facts "$results/$1" "${@:2}"; }
