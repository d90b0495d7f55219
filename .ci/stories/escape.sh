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
# What the device went through, whether it has come to a state since the last that was asked for.
n_lines=0
comes_to() { tail -n "+$((n_lines + 1))" "$work/device.csv" 2> /dev/null | grep -q "$1"; }
await_state() {
  await 20 comes_to "$1" || fail "$2; the device said last: $(tail -n 3 "$work/device.csv" | tr '\n' ' ')"
  n_lines=$(wc -l < "$work/device.csv")
}
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
await_state READY "the device was not found"
sleep 1
slowly "mousemove $arm" 'click 1'
await_state ARMED "the device was never armed"
shot armed
slowly 'key Escape'
await_state READY "Esc did not stop the device"
shot all-off
slowly "mousemove $escape" 'click 1'
sleep 1
shot gone-on
stop
