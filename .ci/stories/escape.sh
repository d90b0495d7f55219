#!/usr/bin/env bash
# Esc with nothing armed pauses and the screen goes on: R records what is shown. Esc while armed turns
# everything off, and one act goes on.
. "$(dirname "$0")/lib.sh"
# Where the window shows the port, Arm, and what Esc would do.
port='1180 497'
arm='1230 449'
escape='1340 22'
display
"$selvedge" bridge emulate --link "$work/array" --log "$work/device.csv" > /dev/null 2>&1 &
device=$!
start
# It moves by itself from the start: paused by Esc, moved on by Space, recorded without a device armed.
sleep 1
shot moving
slowly 'key Escape'
shot paused
slowly 'key space' 'key r'
sleep 2
slowly 'key r'
sleep 1
recording=$(ls -d "$work/data/selvedge/recordings"/*Z* | head -n 1)
n_rows=$(wc -l < "$recording/ticks.csv")
[ "$n_rows" -gt 40 ] || fail "only $n_rows rows were recorded after Esc"
# A list of keys over the panes is closed by Esc before motion is paused.
slowly 'key F1'
shot keys
slowly 'key Escape'
# Armed: everything off at once.
slowly "mousemove $port" 'click 1' "type --delay 30 '$work/array'" 'key Return'
sleep 1.5
slowly "mousemove $arm" 'click 1'
sleep 1.5
shot armed
slowly 'key Escape'
sleep 1
shot all-off
grep -q ARMED "$work/device.csv" || fail "the device was never armed"
awk '/ARMED/ { armed = 1 } armed && /READY/ { off = 1 } END { exit !off }' "$work/device.csv" ||
  fail "Esc did not stop the device"
slowly "mousemove $escape" 'click 1'
sleep 1
shot gone-on
stop
