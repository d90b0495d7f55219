#!/usr/bin/env bash
# The Stylus pane by real keys and a real pointer: found by its name, it shows what moves, and a stiffness that cannot be
# held is asked about before it is applied.
. "$(dirname "$0")/lib.sh"

# What stands below the sliders.
words() { import -window root -crop 300x130+4+375 +repage rgb:- | md5sum; }
say_other() { [ "$(words)" != "$1" ]; }

display
start
slowly 'mousemove 760 14' 'key ctrl+k' 'type --delay 40 Stylus' 'key Return' 'key shift+F11'
sleep 1
look still
await 15 differs still 3000 || fail "nothing moves in the pane"
shot moves
slowly 'mousemove 284 341' 'click 1' 'mousemove 760 14'
sleep 1
shot sampled
held=$(words)
slowly 'mousemove 172 84' 'mousedown 1' 'mousemove 190 84' 'mousemove 226 84' 'mouseup 1' 'mousemove 760 14'
await 10 say_other "$held" || fail "a stiffness that cannot be held is not asked about"
shot asked
stop
