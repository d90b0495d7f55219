#!/usr/bin/env bash
# Everything by keys, and panes by two clicks: found by name, the guide, the list of keys, from pane to pane, one pane alone,
# sound on a machine that plays none.
. "$(dirname "$0")/lib.sh"
display
# No server of sound, and a card that nobody has.
mkdir "$work/bin"
printf '#!/bin/sh\nexit 1\n' > "$work/bin/aplay"
chmod +x "$work/bin/aplay"
PATH=$work/bin:$PATH PULSE_SERVER=$work/none start
slowly 'key Escape'
# A textile of another library, found by a few letters and laid into the scene.
slowly 'key ctrl+k' "type --delay 30 'poplin'"
sleep 1
shot palette
slowly 'key Return'
sleep 1
slowly 'key ctrl+shift+s'
answer "$work/found.scene.toml"
grep -q poplin "$work/found.scene.toml" || fail "the textile that was found is not in the scene"
# The guide, found by its name; Esc closes it.
look before
slowly 'key ctrl+p' "type --delay 30 'guide'" 'key Return'
sleep 1
shot guide
look guide
[ "$(differ before guide)" -gt 100000 ] || fail "the guide is not shown"
slowly 'key Escape'
slowly 'key F1' "type --delay 30 'redo'"
shot keys
slowly 'key Escape'
sleep 0.5
look after
[ "$(differ before after)" -lt 20000 ] || fail "Esc did not close what lay on top"
# From pane to pane: the frame of the one that has the focus moves.
slowly 'key F6'
look first
slowly 'key F6'
look second
shot walked
[ "$(differ first second)" -gt 500 ] || fail "F6 does not show where it goes"
slowly 'key shift+F6'
look back
[ "$(differ first back)" -lt "$(differ first second)" ] || fail "Shift+F6 does not go back"
# One pane alone, and all again.
slowly 'key shift+F11'
sleep 0.5
shot alone
look alone
[ "$(differ back alone)" -gt 200000 ] || fail "no pane stands alone"
slowly 'key shift+F11'
sleep 0.5
look again
[ "$(differ back again)" -lt 20000 ] || fail "the panes did not come back"
# The same by the pointer: two clicks on a tab, and two on the tab of the one that is left.
double_click() { xdotool mousemove "$1" "$2" click --repeat 2 --delay 90 1; }
double_click 230 56
await 10 differs again 200000 || fail "two clicks on a tab show no pane alone"
shot double-click
double_click 30 56
await 10 looks_like again 20000 || fail "two clicks on a tab do not bring the panes back"
# Sound that nothing plays greys the loudspeaker, and one line says why, until it is off again.
loudspeaker() { import -window root -crop 40x30+1160+8 +repage "$work/look-$1.png"; }
loudspeaker off
look quiet
slowly 'key ctrl+m'
await 10 differs quiet 1500 || fail "nothing says that nothing is heard"
shot unheard
loudspeaker unheard
[ "$(differ off unheard)" -gt 20 ] || fail "the loudspeaker looks as before"
slowly 'key ctrl+m'
await 10 looks_like quiet 1500 || fail "the line stays though sound is off"
loudspeaker silent
[ "$(differ off silent)" -lt 20 ] || fail "Ctrl+M twice changes the loudspeaker"
# Full screen and back: without a window manager the window stays as it is, and keeps its keys.
slowly 'key F11' 'key F11'
await 10 looks_like again 20000 || fail "F11 twice changes the window"
stop
"$selvedge" help | grep -q workbench || fail "the guide is not listed"
"$selvedge" help bridge | grep -q '^## Armed' || fail "a page of the guide is not printed"
