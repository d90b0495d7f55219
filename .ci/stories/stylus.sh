#!/usr/bin/env bash
# The Stylus pane by real keys and a real pointer: found by its name, it shows what moves, a stiffness that cannot be held
# is asked about before it is applied, it is felt in place of the array and recorded, and settings are there at the next
# start, with what waits.
. "$(dirname "$0")/lib.sh"

# What stands below the sliders.
words() { import -window root -crop 300x130+4+425 +repage rgb:- | md5sum; }
say_other() { [ "$(words)" != "$1" ]; }
keeps() { grep -A 14 "^\[$1\]" "$XDG_CONFIG_HOME/selvedge/settings.toml" | grep -q "$2"; }
is_recorded() { grep -q '^stylus = "K ' "$XDG_DATA_HOME"/selvedge/recordings/*/recording.toml; }

display
start
slowly 'mousemove 760 14' 'key ctrl+k' 'type --delay 40 Stylus' 'key Return' 'key shift+F11'
sleep 1
look still
await 15 differs still 3000 || fail "nothing moves in the pane"
shot moves
slowly 'mousemove 284 362' 'click 1' 'mousemove 760 14'
sleep 1
shot sampled
held=$(words)
slowly 'mousemove 172 84' 'mousedown 1' 'mousemove 190 84' 'mousemove 226 84' 'mouseup 1' 'mousemove 760 14'
await 10 say_other "$held" || fail "a stiffness that cannot be held is not asked about"
shot asked
await 10 keeps stylus_waiting 'stiffness_n_per_m = 100000' || fail "what waits is not kept"
asked=$(words)

# Through the device: the textiles are prepared one after the other.
look array
slowly 'mousemove 269 410' 'click 1' 'mousemove 760 14'
await 10 say_other "$asked" || fail "nothing says that the stylus is felt"
sleep 12
shot felt
slowly 'key r'
sleep 2
slowly 'key r'
await 10 is_recorded || fail "the recording does not say which stylus was felt"
stop
start
slowly 'mousemove 760 14' 'key ctrl+k' 'type --delay 40 Stylus' 'key Return' 'key shift+F11'
sleep 1
shot again
keeps stylus 'sampled = true' && keeps stylus_waiting 'stiffness_n_per_m = 100000' || fail "settings are gone"
stop
