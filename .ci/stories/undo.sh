#!/usr/bin/env bash
# Undo acts on the pane in use: a slider in the lab, Ctrl+Z there, and the scene stays as it is.
. "$(dirname "$0")/lib.sh"
display
start
# A change of the scene that undo in the lab must not touch: a saved file would miss it.
slowly 'key a' 'mousemove 545 400' 'click 1' 'key Delete'
shot removed
slowly 'key ctrl+2'
sleep 3
# Any number of the recipe: the first slider's rail.
slowly 'mousemove 405 260' 'click 1'
sleep 2
shot changed
slowly 'key ctrl+z' 'key ctrl+z' 'key ctrl+z' 'key ctrl+z'
sleep 1
shot undone
slowly 'key ctrl+s'
answer "$work/after.scene.toml"
n=$(grep -c '^\[\[textile\]\]' "$work/after.scene.toml") || fail "the scene was not saved"
[ "$n" = 3 ] || fail "undo in the lab changed the scene: $n textiles"
slowly 'key ctrl+1'
sleep 1
slowly 'key ctrl+z'
slowly 'key ctrl+shift+s'
answer "$work/again.scene.toml"
n=$(grep -c '^\[\[textile\]\]' "$work/again.scene.toml") || fail "the scene was not saved"
[ "$n" = 4 ] || fail "undo in the workspace brought nothing back: $n textiles"
stop
