#!/usr/bin/env bash
# Visitors come and go at the stage for SOAK_S seconds (600): memory, threads and open files stay what they were after
# twenty of them, every visit has its row, and the device misses no tick.
. "$(dirname "$0")/../lib.sh"
display 1280x720
log=$work/data/selvedge/stage
"$selvedge" bridge emulate --link "$work/array" --log "$work/device.csv" > "$work/device.txt" 2>&1 &
device=$!
await 20 test -e "$work/array" || fail "no emulator"
printf 'port = "%s"\n' "$work/array" > "$work/stage.toml"
start --stage --operator "$work/stage.toml"
visits=0
visit() {
  local x=$((440 + visits % 2 * 260)) y=$((150 + visits / 2 % 2 * 270))
  xdotool mousemove "$x" "$y" mousedown 1
  for step in $(seq 8); do
    xdotool mousemove $((x + step % 4 * 25)) "$y"
    sleep 0.1
  done
  xdotool mouseup 1
  # Begin anew: held for a second, and longer where frames are late.
  visits=$((visits + 1))
  for hold in 1.4 3 6; do
    xdotool mousemove 1133 680 mousedown 1
    sleep "$hold"
    xdotool mouseup 1
    await 5 all_rows && return
  done
  fail "$(rows) rows of $visits visits"
}
rows() { tail -n +2 "$log/visits.csv" | wc -l; }
all_rows() { [ "$(rows)" = "$visits" ]; }
kib() { awk '/^VmRSS/ { print $2 }' "/proc/$program/status"; }
count() { ls "/proc/$program/$1" | wc -l; }
for _ in $(seq 20); do visit; done
before=$(kib)
threads=$(count task)
files=$(count fd)
until=$((SECONDS + ${SOAK_S:-600}))
while [ "$SECONDS" -lt "$until" ]; do visit; done
after=$(kib)
echo "$story: $visits visits, $before → $after KiB, $threads → $(count task) threads, $files → $(count fd) files"
[ $((after - before)) -lt 5120 ] || fail "memory grew from $before to $after KiB"
[ "$(count task)" = "$threads" ] || fail "threads: $threads, now $(count task)"
[ "$(count fd)" = "$files" ] || fail "open files: $files, now $(count fd)"
stop
kill -TERM "$device"
wait "$device" || fail "the emulator: $(cat "$work/device.txt")"
device=
echo "$story: $(tail -n 1 "$work/device.txt")"
