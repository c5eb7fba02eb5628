# Sourced by the scripts that make pages: tables and single numbers of the CSV files in $results, as
# markdown. Needs bash and awk.

have() { [[ -f $results/$1 ]]; }

# What the awk programs below share: columns by name without unit, numbers in four digits.
library='
function name(field) { sub(/\[.*/, "", field); return field }
function is_number(text) { return text ~ /^-?[0-9.]+(e[-+]?[0-9][0-9]?[0-9]?)?$/ }  # no revision like 61e1436
function pretty(text,  size) {
  if (text == "nan") return "-"
  if (!is_number(text) || text ~ /^-?[0-9]+$/) return text
  size = text < 0 ? -text : text + 0
  if (size >= 1000 && size < 1e6) return sprintf("%.0f", text)
  if (size >= 1e-3 && size < 1000) return sprintf("%.3g", text)
  text = sprintf("%.2e", text)
  sub(/\.?0*e/, "e", text); sub(/e-0/, "e-", text); sub(/e\+0?/, "e", text)
  return text
}
function same(a, b) {
  if (!is_number(a) || !is_number(b)) return a == b
  return a - b <= 1e-6 * b && b - a <= 1e-6 * b
}
NR == 1 { for (k = 1; k <= NF; ++k) column[name($k)] = k }
'

# `table FILE [COLUMN...] [-- COLUMN=VALUE...]` as markdown: these columns (default: all) of the rows
# that match. Columns that the file does not have are left out.
table() {
  local file=$results/$1 columns=() conditions=()
  shift
  while (($#)) && [[ $1 != -- ]]; do columns+=("$1"); shift; done
  if (($#)); then shift; conditions=("$@"); fi
  awk -F, -v columns="${columns[*]}" -v conditions="${conditions[*]}" "$library"'
    NR == 1 {
      wanted = split(columns, chosen, " ")
      for (k = 1; k <= wanted; ++k) if (chosen[k] in column) shown[++count] = column[chosen[k]]
      if (!wanted) for (k = 1; k <= NF; ++k) shown[++count] = k
      tests = split(conditions, test, " ")
      line = "|"; rule = "|"
      for (k = 1; k <= count; ++k) {
        head = $shown[k]
        gsub(/_/, " ", head); sub(/\[/, " [", head)
        line = line " " head " |"; rule = rule "---|"
      }
      print line "\n" rule
      next
    }
    {
      for (k = 1; k <= tests; ++k) {
        split(test[k], part, "=")
        if (!same($column[part[1]], part[2])) next
      }
      line = "|"
      for (k = 1; k <= count; ++k) line = line " " pretty($shown[k]) " |"
      print line
    }' "$file"
}

# `value FILE COLUMN COLUMN=VALUE...`: the first row that matches; "?" when there is none.
value() {
  local file=$results/$1 wanted=$2
  shift 2
  awk -F, -v wanted="$wanted" -v conditions="$(IFS=';' && echo "$*")" "$library"'
    NR == 1 { tests = split(conditions, test, ";"); next }
    {
      for (k = 1; k <= tests; ++k) {
        split(test[k], part, "=")
        if (!same($column[part[1]], part[2])) next
      }
      print pretty($column[wanted]); found = 1; exit
    }
    END { if (!found) print "?" }' "$file"
}
