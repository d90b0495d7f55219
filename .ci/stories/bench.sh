#!/usr/bin/env bash
# An expert at the tuning bench: two tunings in slots, one felt while its key is held, a level that is typed, a
# proposal that is taken, and all of it in the scene's file.
. "$(dirname "$0")/lib.sh"
display
start
# What stands beside the letters: whether a slot is held.
sight() { import -window root -crop 60x22+1280+73 "$work/sight-$1.png"; }
apart() { ! compare -metric AE "$work/sight-$1.png" "$work/sight-$2.png" null: > /dev/null 2>&1; }
slowly 'mousemove 1098 84' 'click 1'
# The master's number is typed over.
slowly 'mousemove 1350 169' 'click 1' 'key ctrl+a' "type --delay 30 -- '-14'" 'key Return'
slowly 'mousemove 1118 84' 'click 1'
sleep 1
shot kept
sight now
slowly 'keydown alt' 'keydown a'
sleep 1
shot held
sight held
slowly 'keyup a' 'keyup alt'
sleep 1
sight after
apart now held || fail "holding Alt+A does nothing"
apart now after && fail "slot A is held although its key was let go"
slowly 'key ctrl+s'
answer "$work/bench.scene.toml"
grep -q '^letter = "A"' "$work/bench.scene.toml" || fail "slot A was not saved"
grep -q 'gain_db = -14.0' "$work/bench.scene.toml" || fail "slot B holds no master of -14 dB"
# Levels: a proposal is shown, then taken.
slowly 'mousemove 1143 56' 'click 1'
sleep 3
slowly 'mousemove 1354 84' 'click 1'
sleep 1
shot proposed
slowly 'mousemove 1100 129' 'click 1'
sleep 1
slowly 'key ctrl+s'
sleep 2
grep -A6 'id = "jute-plain"' "$work/bench.scene.toml" | grep -q '^gain_db = -' || fail "the proposal was not taken"
slowly 'mousemove 1346 56' 'click 1'
sleep 1
shot plane
stop
