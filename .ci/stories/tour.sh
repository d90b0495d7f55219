# Somebody starts the program for the first time: each step of the tour is over once it was done with real hands. Then
# a key is changed in the list of keys, works, and is there at the next start, where no tour is offered again.
. "$(dirname "$0")/lib.sh"

settings=$XDG_CONFIG_HOME/selvedge/settings.toml
keeps() { grep -qF "$1" "$settings" 2> /dev/null; }
# The line of the tour says how many steps are over.
shown() { import -window root -crop 44x20+1194+52 +repage rgb:- | md5sum; }
has_moved_on() { [ "$(shown)" != "$step" ]; }
expect_step() { await 10 has_moved_on || fail "$1"; sleep 0.5; step=$(shown); }

display
is_first=1
start
step=$(shown)
for i in $(seq 60); do xdotool mousemove $((300 + i * 3)) 300 sleep 0.03; done
expect_step 'feeling the cloth is not noticed'
slowly 'mousemove 100 640' 'click 1'
expect_step 'choosing a contactor is not noticed'
slowly 'mousemove 1247 149' 'mousedown 1' 'mousemove 1225 149' 'mousemove 1215 149' 'mouseup 1'
expect_step 'turning a slider is not noticed'
slowly 'mousemove 1236 468' 'click 1'
sleep 1.5
slowly 'key Escape'
expect_step 'arming and switching off is not noticed'
shot last-step
slowly 'key ctrl+k'
expect_step 'the palette is not noticed'
slowly 'key Escape'

slowly 'key F1'
sleep 0.5
# “Play one tick”: its key is “.”.
slowly 'mousemove 678 611' 'click 1' 'key ctrl+z'
shot keys
slowly 'mousemove 678 611' 'click 1' 'key alt+n'
await 5 keeps '"Play one tick" = "Alt+N"' || fail 'the key is not kept'
slowly 'key Escape'
stop

is_first=
start
slowly 'key F1'
shot keys-again
step=$(shown)
slowly 'mousemove 678 611' 'click 1' 'key Delete'
await 5 eval '! keeps "Play one tick"' || fail 'the key is not as at first again'
stop
