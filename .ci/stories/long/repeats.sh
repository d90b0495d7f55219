#!/usr/bin/env bash
# Three equal quick reports beside a busy core: of the times of the second and of the third 95 in 100 have intervals that
# overlap with the first's. Told when it is asked for: bash .ci/stories/long/repeats.sh PROGRAM
set -euo pipefail
selvedge=$(realpath "$1")
work=$(mktemp -d)
while :; do :; done &
load=$!
trap 'kill $load; rm -rf "$work"' EXIT

"$selvedge" --quiet report --quick --out "$work/1"
for n in 2 3; do
  "$selvedge" --quiet report --quick --out "$work/$n" --against "$work/1/report.json"
  sed -n '/^## Since/,/^- Less memory/p' "$work/$n/index.md" | grep -e 'overlap' -e '^- '
  share=$(sed -n 's/.*intervals of \([0-9]*\)\..* % overlap.*/\1/p' "$work/$n/index.md")
  [ "${share:-0}" -ge 95 ] || { echo "repeats: ${share:-0} % overlap where 95 are asked for"; exit 1; }
done
