#!/bin/bash
# Two builds of one benchmark in turn, where the benchmark prints a table: medians of both, and of their ratios.
#   tests/bench/bench_ratio.sh FORMER NEW ROUNDS [ARGUMENT...]
#   tests/bench/bench_ratio.sh --counts FUNCTION FORMER NEW [ARGUMENT...]
# Each round runs both with the arguments, the former first in every second one. Rows are told by their first cell; of each
# other cell the first number counts. Prints "former; new: former / new (least..largest)". --counts prints the instructions that both
# execute within FUNCTION (a pattern of callgrind's --toggle-collect) instead.
set -euo pipefail
export LC_ALL=C
usage() { sed -n '3,4s/^# *//p' "$0" >&2; exit 2; }
if [[ ${1:-} == --counts ]]; then
  [[ $# -ge 4 ]] || usage
  function=$2 former=$3 new=$4
  shift 4
  for program in "$former" "$new"; do
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect="$function" "$program" "$@" 2>&1 >/dev/null |
      sed -n 's/.*Collected : *//p'
  done | awk 'NR == 1 { a = $1 } NR == 2 { printf "instructions, former; new: %.1f; %.1f million: %.3f\n", a / 1e6, $1 / 1e6, a / $1 }'
  exit
fi
[[ $# -ge 3 && $3 =~ ^[1-9][0-9]*$ ]] || usage
former=$1 new=$2 rounds=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for ((n = 1; n <= rounds; ++n)); do
  order=(former new)
  if ((n % 2 == 0)); then order=(new former); fi
  for one in "${order[@]}"; do
    "${!one}" "$@" 2>/dev/null | grep '^|' | grep -v '^|[-|]*$' | sed "s/^/$n $one /" >>"$work/rows"
  done
done
awk -v rounds="$rounds" '
function median(list, count,    k, m, t) {
  for (k = 2; k <= count; ++k)
    for (m = k; m > 1 && list[m - 1] > list[m]; --m) { t = list[m]; list[m] = list[m - 1]; list[m - 1] = t }
  return count % 2 ? list[(count + 1) / 2] : (list[count / 2] + list[count / 2 + 1]) / 2
}
{
  round = $1; who = $2
  line = $0; sub(/^[^|]*\|/, "", line); sub(/\|[^|]*$/, "", line)
  count = split(line, cells, "|")
  name = cells[1]
  if (!(name in seen)) { seen[name] = 1; names[++rows] = name }
  columns[name] = count
  for (c = 2; c <= count; ++c)
    if (match(cells[c], /[0-9]+([.][0-9]+)?/)) value[who, round, name, c] = substr(cells[c], RSTART, RLENGTH)
    else text[name, c] = cells[c]
}
END {
  for (r = 1; r <= rows; ++r) {
    out = "|" names[r] "|"
    for (c = 2; c <= columns[names[r]]; ++c) {
      count = 0; delete a; delete b; delete q
      for (n = 1; n <= rounds; ++n)
        if ((("former", n, names[r], c) in value) && (("new", n, names[r], c) in value) && value["new", n, names[r], c] > 0) {
          ++count
          a[count] = value["former", n, names[r], c] + 0
          b[count] = value["new", n, names[r], c] + 0
          q[count] = a[count] / b[count]
        }
      if (count < rounds) { out = out " " text[names[r], c] " |"; continue }
      ratio = median(q, count)
      out = out sprintf(" %g; %g: %.2f (%.2f..%.2f) |", median(a, count), median(b, count), ratio, q[1], q[count])
    }
    print out
  }
}' "$work/rows"
