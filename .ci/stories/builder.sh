#!/usr/bin/env bash
# A design is built by real hands: a textile is dragged from the library into its stimuli, taken back, brought
# again, saved with its comments, and tried as a pilot; what was not saved is there after a crash.
. "$(dirname "$0")/lib.sh"
study=$work/study
design=$work/pairs.toml
mkdir -p "$XDG_CONFIG_HOME/selvedge" "$study"
cat > "$design" << 'DESIGN'
# Which of two is the rougher?
study = "s"
experiment = "pairs"
medium = "array"
seed = 1
textiles = ["silk-crepe", "wool-twill"] # two to begin with

[presentation]
kind = "pair"

[response]
kind = "choice"
DESIGN
cat > "$XDG_CONFIG_HOME/selvedge/settings.toml" << SETTINGS
sessions_folder = "$study"
experiment_design = "$design"
SETTINGS
holds() { grep -q "$1" "$design"; }
pilot() { ls "$study"/pilots/*.csv > /dev/null 2>&1; }
display
start
slowly 'key Escape' 'key ctrl+k' "type --delay 30 'Study builder'" 'key Return'
sleep 1
# The block of stimuli; then jute, from the library to the others.
slowly 'mousemove 260 152' 'click 1'
xdotool mousemove 110 215 mousedown 1 sleep 0.3
for step in $(seq 1 20); do
  xdotool mousemove $((110 + step * 15)) $((215 - step)) sleep 0.03
done
xdotool mouseup 1
sleep 1
shot dragged
slowly 'mousemove 551 86' 'click 1'
await 10 holds '"silk-crepe", "wool-twill", "jute-plain"' || fail "it is not saved"
holds '# two to begin with' && holds '# Which of two' || fail "comments are lost"
slowly 'key ctrl+z' 'mousemove 551 86' 'click 1'
await 10 holds '"wool-twill"\]' || fail "it is not taken back"
slowly 'key ctrl+shift+z'
sleep 1
shot again
# Not saved: a crash offers it.
sleep 6
crash
start
shot offered
slowly 'mousemove 1232 62' 'click 1'
sleep 2
shot restored
slowly 'mousemove 551 86' 'click 1'
await 10 holds jute-plain || fail "what was not saved is lost"
slowly 'mousemove 706 482' 'click 1' # the pilot
await 60 pilot || fail "no pilot begins"
sleep 2
shot pilot
stop
