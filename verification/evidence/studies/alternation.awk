# awk -v columns=COLUMNS -f alternation.awk NAME_every_FIELD.csv: how a field of four-point elements, in rows of COLUMNS,
# goes from point to point in the last row of the table. Two numbers over the range of the field: the mean
# difference of neighbouring points, and how far it goes to and fro along lines of points: the mean of the smaller
# of two differences that follow one another with opposite signs, else 0. Points of one element that have the same
# value count as one.
BEGIN { FS = "," }
{ last = $0 }
END {
  count = split(last, value) - 1
  rows = count / 4 / columns
  least = most = value[2]
  for (element = 0; element < count / 4; ++element)
    for (corner = 0; corner < 4; ++corner) {
      x = 2 * (element % columns) + (corner == 1 || corner == 2)
      y = 2 * int(element / columns) + (corner > 1)
      v = field[x, y] = value[2 + 4 * element + corner]
      if (v < least) least = v
      if (v > most) most = v
    }
  if (most <= least) { print "0,0"; exit }
  for (y = 0; y < 2 * rows; ++y) { n = 0; for (x = 0; x < 2 * columns; ++x) line[++n] = field[x, y]; add() }
  for (x = 0; x < 2 * columns; ++x) { n = 0; for (y = 0; y < 2 * rows; ++y) line[++n] = field[x, y]; add() }
  printf "%.4f,%.4f\n", apart / pairs / (most - least), triples ? to_and_fro / triples / (most - least) : 0
}
function size(a) { return a < 0 ? -a : a }
function add(  k, before, now) {
  before = ""
  for (k = 2; k <= n; ++k) {
    now = line[k] - line[k - 1]
    apart += size(now); ++pairs
    if (size(now) <= 1e-6 * (most - least)) continue
    if (before != "") {
      ++triples
      if (now * before < 0) to_and_fro += size(now) < size(before) ? size(now) : size(before)
    }
    before = now
  }
}
