# A recording on the line of time: zoomed, panned, marked by key and named in place, a part of it
# selected and cut; then a look back at what was felt last.
source "$(dirname "$0")/lib.sh"
display
start
slowly "key r"
sleep 5
slowly "key r"
sleep 1
folder=$work/data/selvedge/recordings
first=$(ls -d "$folder"/*Z*)
# The source below the buttons at the left end of the bar.
slowly "mousemove 200 790" "click 1" "key Home"
sleep 1
shot whole
slowly "mousemove 800 800" "click 4" "click 4" "click 4" "click 4"
sleep 0.5
shot zoomed
slowly "mousedown 1" "mousemove 700 800" "mousemove 640 800" "mouseup 1"
sleep 0.5
shot panned
slowly "mousemove 760 746" "click 1"
sleep 0.5
slowly "key shift+m"
slowly "key ctrl+a" "type --delay 40 'a thread'" "key Return"
sleep 0.8
shot marked
grep -q '^name = "a thread"' "$first/recording.toml" || fail "the marker is not on the page"
# Two clicks show all of it again.
slowly "mousemove 900 850"
xdotool click --repeat 2 --delay 90 1
sleep 0.8
slowly "keydown shift" "mousemove 600 800" "mousedown 1" "mousemove 700 800" "mousemove 800 800" "mouseup 1" "keyup shift"
sleep 0.5
shot selected
# The second button of the selection, at its upper left corner.
slowly "mousemove 660 764" "click 1"
sleep 1.5
n=$(ls -d "$folder"/*Z* | wc -l)
[ "$n" = 2 ] || fail "$n recordings instead of the whole and its part"
part=$(ls -td "$folder"/*Z* | head -n 1)
[ "$(wc -l < "$part/ticks.csv")" -lt "$(wc -l < "$first/ticks.csv")" ] || fail "the part is as long as the whole"
# What was felt last, in every view.
slowly "key p" "mousemove 600 300" "mousemove 640 330" "mousemove 690 360" "mousemove 640 300"
slowly "mousemove 700 800" "click 1"
sleep 0.8
shot past
stop
