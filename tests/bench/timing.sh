# Shared by benchmarks in bash that run two programs in turn. TIMEFORMAT must be '%R %U %S', and $work a folder.
seconds() { # of a function: wall, processor
  local took
  took=$({ time "$1" >"$work/log" 2>&1; } 2>&1)
  awk '{ print $1, $2 + $3 }' <<<"$took"
}
median() { sort -g | awk '{ x[NR] = $1 } END { print (NR % 2) ? x[(NR + 1) / 2] : (x[NR / 2] + x[NR / 2 + 1]) / 2 }'; }
