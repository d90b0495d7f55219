#!/usr/bin/env bash
# SIGKILL at moments drawn by chance, while a gain is typed again and again and what is felt is recorded:
# every next start offers what there was, and nothing older than 10 s is lost.
#
# kills.sh PROGRAM [KILLS]     3 unless said; SELVEDGE_SEED draws other moments
. "$(dirname "$0")/lib.sh"
n_kills=${2:-3}
RANDOM=${SELVEDGE_SEED:-1}
# Where the window shows the master gain, and the first answer to the offer.
gain='1320 112'
restore='1232 62'
now() { date +%s.%3N; }
unsaved() { ls -d "$work"/state/selvedge/unsaved/*/work.json 2> /dev/null || true; }
kept_gain() { cat "$1" 2> /dev/null | grep -o "scene.tuning\]\\\\ngain_db = [-0-9.]*" | sed "s/.*= //" || true; }
is_taken_up() { [ ! -e "$1" ] && [ "$(kept_gain "$(unsaved | tail -n 1)")" = "$2" ]; }

# Types one gain after the other, each noted when it was typed, until the window is gone.
type_gains() {
  local tenths=$((20 + RANDOM % 10))
  while kill -0 "$program" 2> /dev/null; do
    tenths=$((tenths + 1 + RANDOM % 2))
    [ "$tenths" -lt 290 ] || tenths=30
    local value=-$((tenths / 10)).$((tenths % 10))
    [ $((tenths % 10)) != 0 ] || continue
    slowly "mousemove $gain" "click 1" "key ctrl+a" "type -- $value" "key Return" 2> /dev/null || return 0
    echo "$(now) $value" >> "$work/typed"
  done
}

# The age of the oldest gain that is lost when $2 is what was kept of those that were typed until $1.
lost_s() {
  awk -v end="$1" -v kept="$2" '
    { if (first == "") first = $1; if ($2 == kept) first = ""; else if (first == "") first = $1 }
    END { printf "%.1f", (first == "" || first > end) ? 0 : end - first }' "$work/typed"
}

display
worst_gain=0
worst_ticks=0
echo "0 -2.0" > "$work/typed"
for kill in $(seq "$n_kills"); do
  start
  before=$(unsaved)
  if [ -n "$before" ]; then
    gain_before=$(kept_gain "$before")
    slowly "mousemove $restore" "click 1"
    await 30 is_taken_up "$before" "$gain_before" || fail "kill $kill: $gain_before dB was not taken up"
    echo "0 $gain_before" > "$work/typed"
  elif [ "$kill" -gt 1 ] && [ "$expected" = yes ]; then
    fail "kill $kill: nothing was offered"
  else
    # Killed before anything was kept: this start begins anew.
    echo "0 -2.0" > "$work/typed"
  fi
  slowly 'key r'
  recorded=$(now)
  after=$(awk "BEGIN { print 2 + 20 * $RANDOM / 32768 }")
  victim=$program
  (sleep "$after"; kill -KILL "$victim"; now > "$work/killed") &
  killer=$!
  type_gains
  wait "$killer"
  wait "$program" 2> /dev/null || true
  killed=$(cat "$work/killed")
  kept=$(kept_gain "$(unsaved | tail -n 1)")
  lost=$(lost_s "$killed" "${kept:--2.0}")
  table=$(ls -td "$work"/data/selvedge/recordings/*Z* | head -n 1)/ticks.csv
  ticks_lost=$(tail -n 2 "$table" | head -n 1 | awk -F, -v s="$recorded" -v e="$killed" '{ lost = e - s - $1; printf "%.1f", (lost > 0 ? lost : 0) }')
  echo "kill $kill after $after s: $(wc -l < "$work/typed") gains, kept ${kept:-none}, lost the last $lost s of gains, $ticks_lost s of the recording"
  awk "BEGIN { exit !($lost <= 10 && $ticks_lost <= 10) }" || fail "kill $kill: more than 10 s are lost"
  expected=$([ -n "$kept" ] && echo yes || echo no)
  worst_gain=$(awk "BEGIN { print ($lost > $worst_gain) ? $lost : $worst_gain }")
  worst_ticks=$(awk "BEGIN { print ($ticks_lost > $worst_ticks) ? $ticks_lost : $worst_ticks }")
done
start
n=$(ls -d "$work"/data/selvedge/recordings/*Z* | wc -l)
[ "$n" = "$n_kills" ] || fail "$n recordings of $n_kills"
all_counted() { [ "$(grep -l '^ticks' "$work"/data/selvedge/recordings/*/recording.toml | wc -l)" = "$n" ]; }
await 20 all_counted || fail "not every recording is listed"
stop
echo "$n_kills kills: at worst the last $worst_gain s of gains and $worst_ticks s of a recording were lost"
