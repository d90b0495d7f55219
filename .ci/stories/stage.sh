#!/usr/bin/env bash
# A visitor strokes, guesses and leaves; closing the window closes nothing; a crash in the middle of a visit leaves a
# whole log.
. "$(dirname "$0")/lib.sh"
display 1280x720
log=$work/data/selvedge/stage
start --stage
shot watching
rows() { tail -n +2 "$log/visits.csv" | wc -l; }
has_rows() { [ "$(rows)" -ge "$1" ]; }
[ "$(rows)" = 0 ] || fail "a visit before the first touch"
stroke 440 150
stroke 700 150
shot touching
stroke 440 420
sleep 0.5
shot offered
# "Guess" stands in the middle of the row.
slowly 'mousemove 640 598' 'click 1'
for round in 1 2 3; do
  stroke 600 300
  slowly "key $round"
  sleep 3.2
done
shot ended
# Esc, a key of the workbench, and a request to close end nothing.
slowly 'key Escape' 'key ctrl+q' 'key F9'
kill -0 "$program" || fail "a key ended it"
# Nobody is there any more.
await 60 has_rows 1 || fail "no row after a visit"
grep -q ',mouse,\|,keys,' "$log/visits.csv" || fail "$(cat "$log/visits.csv")"
[ "$(tail -n +2 "$log/guesses.csv" | wc -l)" = 3 ] || fail "not three guesses: $(cat "$log/guesses.csv")"
# A crash in the middle of the next visit.
stroke 440 150
crash
has_rows 1 || fail "the row is gone"
[ "$(tail -c 1 "$log/visits.csv" | xxd -p)" = 0a ] || fail "a row in pieces"
start --stage
stroke 700 420
stop
has_rows 2 || fail "the visit that SIGTERM ended is not there"
tail -n 1 "$log/visits.csv" | grep -q '^2,.*,stop$' || fail "$(cat "$log/visits.csv")"
"$selvedge" stage export --out "$work/out" > /dev/null 2>&1 || fail "no export"
grep -q '^right guesses,' "$work/out/totals.csv" || fail "$(cat "$work/out/totals.csv")"
