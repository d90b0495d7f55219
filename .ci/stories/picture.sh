#!/usr/bin/env bash
# A cloth from its photograph: the picture is in sight at once, its scale and height are typed, the new textile is
# felt beside one of the library, let go, asked for again and kept.
. "$(dirname "$0")/lib.sh"
# A weave whose threads lie 12 and 10 px apart.
convert -size 240x200 xc: -fx '0.5+0.2*cos(i*pi/6)*cos(j*pi/10)+0.1*cos(i*pi/12)*cos(j*pi/10)+0.02*rand()' \
  -colorspace gray "$work/weave.png"
own=$work/data/selvedge/textiles
# Keep… can be pressed: its words are bright.
is_made() { [ "$(import -window root -crop 60x20+14+661 +repage -format '%[fx:maxima>0.8]' info:)" = 1 ]; }
display
start
slowly 'key Escape' 'key ctrl+k' "type --delay 30 'Picture'" 'key Return' 'mousemove 440 228' 'click 1' 'key ctrl+a' \
  "type --delay 20 '$work/weave.png'" 'key Return'
sleep 1
# The tab's pane fills the window.
slowly 'mousemove 297 56' 'click --repeat 2 --delay 120 1'
sleep 6
shot opened
slowly 'mousemove 95 165' 'click 1' "type --delay 40 '300'" 'key Tab' 'mousemove 90 618' 'click 1' \
  "type --delay 40 '120'" 'key Tab' 'mousemove 150 420' \
  'click --repeat 30 5' 'mousemove 168 434' 'click 1'
sleep 3
await 100 is_made || fail "the textile is never made"
shot made
slowly 'mousemove 42 671' 'click 1'
sleep 2
shot asked
slowly 'mousemove 512 792' 'click 1'
sleep 1
shot compared
# Esc keeps nothing, and the pane is back.
slowly 'key Escape'
sleep 1
shot back
[ ! -e "$own/weave" ] || fail "something was kept without a word"
slowly 'mousemove 243 463' 'click 1'
sleep 2
slowly 'mousemove 515 849' 'click 1'
await 20 test -s "$own/weave/textile.toml" || fail "nothing was kept"
sleep 1
shot kept
grep -q '^\[source.synthesis\]' "$own/weave/textile.toml" || fail "it is not synthesized"
stop
