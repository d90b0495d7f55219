#!/usr/bin/env bash
# Real fingers on a real X server: a touch screen of Xorg's own test device, for what no pointer can do. Told when it
# is asked for; it needs Xorg with its dummy screen (xserver-xorg-core, xserver-xorg-video-dummy) and perl:
#
#   SELVEDGE_SHOTS=FOLDER bash .ci/stories/long/touch.sh PROGRAM
#
# Visitors stroke the stage, alone and by two, and stop the device with a finger that holds nothing; two fingers hold
# the two displays of a scene at the bench; and all of it at twice the size.
. "$(dirname "$0")/../lib.sh"

touch_display() {
  cat > "$work/xorg.conf" << CONF
Section "ServerLayout"
  Identifier "touch"
  Screen "screen"
  InputDevice "finger"
EndSection
Section "ServerFlags"
  Option "AutoAddDevices" "false"
EndSection
Section "InputDevice"
  Identifier "finger"
  Driver "inputtest"
  Option "SocketPath" "$work/fingers"
  Option "DeviceType" "Touch"
  Option "TouchCount" "10"
EndSection
Section "Device"
  Identifier "dummy"
  Driver "dummy"
  VideoRam 64000
EndSection
Section "Monitor"
  Identifier "monitor"
  HorizSync 5.0-1000.0
  VertRefresh 5.0-200.0
EndSection
Section "Screen"
  Identifier "screen"
  Device "dummy"
  Monitor "monitor"
  DefaultDepth 24
  SubSection "Display"
    Depth 24
    Virtual 1400 900
    Modes "1400x900"
  EndSubSection
EndSection
CONF
  Xorg -displayfd 3 -config "$work/xorg.conf" -logfile "$work/xorg.log" -noreset -nolisten tcp -novtswitch -sharevts \
    3> "$work/display" > "$work/xorg.txt" 2>&1 &
  server=$!
  await 20 test -s "$work/display" || fail "no display"
  export DISPLAY=:$(cat "$work/display")
  await 20 test -S "$work/fingers" || fail "no test device"
  mkfifo "$work/hand"
  perl -e "$fingers" "$work/fingers" < "$work/hand" > "$work/hand.txt" 2>&1 &
  device=$!
  exec 9> "$work/hand"
}

# Lines of "begin|move N X Y" and "end N" become touches of the test device: its protocol 1.1, a header of length and
# kind (0 the version, 6 a touch), then which finger, whether it begins, moves or ends, and 64 valuators with a mask.
# The server answers the version alone. It serves one client as long as it lives.
fingers='
use IO::Socket::UNIX;
my $screen = IO::Socket::UNIX->new(Peer => $ARGV[0]) or die "no device: $!";
$screen->autoflush(1);
print $screen pack("L2S2", 12, 0, 1, 1);
sysread($screen, my $version, 12) == 12 or die "no answer";
my %kinds = (begin => 18, move => 19, end => 20);
while (<STDIN>) {
  my ($what, $finger, $x, $y) = split;
  my @at = ((0) x 128);
  my $mask = 0;
  if (defined $y) {
    @at[0, 1] = ($x * 65535 / 1400, $y * 65535 / 900);
    $mask = 3;
  }
  print $screen pack("L2L2LC8x4d128", 1056, 6, $finger, $kinds{$what}, 0, $mask, (0) x 7, @at);
}
'

finger() { echo "$*" >&9; }

tap() {
  finger begin 9 "$1" "$2"
  sleep 0.12
  finger end 9
  sleep 0.6
}

# rub SECONDS N X Y …: fingers that are down go to and fro at once, 80 px each, finely: a pointer that says nothing
# for 50 ms is at rest, and nothing is felt.
rub() {
  local end=$((${EPOCHREALTIME/./} / 1000 + $1 * 1000)) step=0 away i hands=("${@:2}")
  while [ $((${EPOCHREALTIME/./} / 1000)) -lt "$end" ]; do
    away=$((step % 40 < 20 ? step % 40 : 40 - step % 40))
    for ((i = 0; i < ${#hands[@]}; i += 3)); do
      finger move "${hands[i]}" $((hands[i + 1] + 4 * away)) "${hands[i + 2]}"
    done
    step=$((step + 1))
    sleep 0.012
  done
}

# part NAME WxH+X+Y: keeps a part of the screen as `look` keeps all of it.
part() { import -window root -crop "$2" +repage "$work/look-$1.png"; }
changes() { [ "$(differ "$1" "$2")" -gt "$3" ]; }
stays() { ! changes "$@"; }

# How far a bar of the stage is filled, pixels: those along its middle that are not as its right end is.
bar() {
  import -window root -crop "300x1+1060+$1" +repage txt:- |
    awk 'NR > 1 { of[NR] = $3 } END { for (k in of) n += of[k] != of[NR]; print n + 0 }'
}
both_bars() { [ "$(bar 341)" -ge "$1" ] && [ "$(bar 420)" -ge "$1" ]; }
no_bars() { [ "$(bar 341)" = 0 ] && [ "$(bar 420)" = 0 ]; }

# Columns and words of the newest row of the log.
visit() { tail -n 1 "$log/visits.csv"; }
# The newest thing that the emulated device did.
device_is() { tail -n 1 "$work/device.csv" | cut -d , -f 4 | grep -q "^$1$"; }

touch_display
log=$work/data/selvedge/stage
mkdir -p "$XDG_CONFIG_HOME/selvedge"
printf 'pin = "271828"\nport = "%s"\n' "$work/array" > "$XDG_CONFIG_HOME/selvedge/stage.toml"
chmod 600 "$XDG_CONFIG_HOME/selvedge/stage.toml"
"$selvedge" bridge emulate --link "$work/array" --log "$work/device.csv" > /dev/null 2>&1 &
device="$device $!"
await 20 test -e "$work/array" || fail "no emulated device"

echo "$story: one finger, then two, on the stage"
start --stage
finger begin 1 440 520
rub 4 1 440 520 &
sleep 1.5
await 2 both_bars 5 || fail "a finger strokes jute, and the bars are empty"
part here 200x60+420+425
part away 250x250+720+400
sleep 0.4
part here-later 200x60+420+425
part away-later 250x250+720+400
changes here here-later 20 || fail "no dots follow the finger"
stays away away-later 20 || fail "something moves where no finger is"
shot one-finger
wait $!
part cloth-2 280x280+725+55
finger begin 2 850 250
rub 2 1 440 520 2 850 250 &
sleep 1
part rings 280x280+725+55
both_bars 5 || fail "a second finger took the display"
shot two-fingers
wait $!
changes cloth-2 rings 300 || fail "a second finger draws no ring"
finger end 2
finger end 1
sleep 0.8
no_bars || fail "something is felt after both lifted"
# A finger that rests opens nothing.
finger begin 1 460 520
sleep 0.5
look pressed
sleep 1.5
differs pressed 3000 && fail "a long press opens something"
finger end 1
sleep 0.6
differs pressed 3000 && fail "a long press opens something as it ends"
# What begins on a cloth presses no button where it ends.
part button 170x70+790+735
finger begin 1 800 520
for step in $(seq 25); do
  finger move 1 $((800 + 3 * step)) $((520 + 10 * step))
  sleep 0.015
done
finger end 1
sleep 0.6
part button-later 170x70+790+735
stays button button-later 200 || fail "a drag that came from a cloth pressed a button"
tap 870 765
part button-later 170x70+790+735
changes button button-later 2000 || fail "a tap presses no button"
tap 870 765
shot tapped

echo "$story: a finger that holds nothing stops the device"
slowly 'key ctrl+shift+F12' 'type --delay 120 271828' 'key Return'
sleep 0.6
shot operator
tap 531 760
tap 870 760
finger begin 1 440 250
rub 1 1 440 250
finger end 1
sleep 0.4
finger begin 1 540 765
sleep 1.6
finger end 1
await 3 device_is RUN || fail "no device is armed by a finger that is held"
finger begin 1 440 250
rub 1 1 440 250
shot armed
finger begin 2 1366 845
await 1 device_is 'RAMP\|READY' || fail "STOP does not act under a second finger"
finger end 2
finger end 1
sleep 0.5
shot stopped

echo "$story: a hand that rests beside the cloths"
finger begin 1 150 300
sleep 0.3
finger begin 2 440 520
rub 3 2 440 520 &
sleep 1.5
shot hand-beside
await 1 both_bars 5 || fail "who rests a hand beside the cloths keeps everybody from feeling"
wait $!
finger end 2
finger end 1
sleep 0.5
stop
visit | grep -q '^[0-9]*,[^,]*,[^,]*,[^,]*,touch,' || fail "no visit by touch: $(cat "$log/visits.csv")"
grep -q ',touch,armed,' "$log/visits.csv" || fail "no armed visit: $(cat "$log/visits.csv")"

echo "$story: two fingers at the bench"
cat > "$work/two.scene.toml" << SCENE
name = "Two fingers"
size_mm = [260.0, 260.0]
[[textile]]
id = "jute-plain"
origin_mm = [10.0, 10.0]
size_mm = [240.0, 240.0]
[[display]]
geometry = "exeter-24"
[[display]]
geometry = "exeter-24"
SCENE
start "$work/two.scene.toml"
# The display moves by itself until a finger moves on the cloth.
finger begin 1 330 200
rub 1 1 330 200
finger end 1
slowly 'key r'
finger begin 1 330 200
rub 1 1 330 200
finger begin 2 480 430
rub 2 1 330 200 2 480 430 &
sleep 1
shot both-held
wait $!
finger begin 3 400 300
rub 1 1 330 200 2 480 430 3 400 300 &
sleep 0.6
shot third
wait $!
finger end 3
finger end 1
rub 2 2 480 430
finger end 2
sleep 0.6
slowly 'key r'
sleep 1
ticks=$(ls "$work"/data/selvedge/recordings/*/ticks.csv)
# Ticks in which both were felt apart, and the second alone; what the last tick feels. Together they go until the second
# is held: column 11, its own velocity, is empty while it is not.
felt=$(awk -F , '
  NR == 1 { for (n = 1; n <= NF; n++) if ($n == "a40_um_0") from = n; next }
  {
    one = two = 0
    for (n = 0; n < 48; n++) one += $(from + n)
    for (n = 48; n < 96; n++) two += $(from + n)
    both += $11 != "" && one > 0 && two > 0; second += one == 0 && two > 0; last = one + two
  }
  END { print (both > 30 && second > 20 && last == 0), both, second, last }' "$ticks")
[ "${felt%% *}" = 1 ] || fail "ticks of both, ticks of the second alone, last: $felt"
# Columns 3, 4 and 9 to 11: where the first and the second display are, mm, and how fast the second is while held.
awk -F , 'NR > 1 && $11 != "" && ($9 < 110 || $3 > 105 || $10 > $4 - 100) { exit 1 }' "$ticks" ||
  fail "the second display is not where its finger is"

echo "$story: panes by a finger"
number() { import -window root -crop "70x22+1315+$1" +repage "$work/look-$2.png"; }
number 106 master
finger begin 1 1231 117
for step in $(seq 20); do
  finger move 1 $((1231 + 2 * step)) 117
  sleep 0.04
done
sleep 0.5
finger end 1
sleep 0.6
number 106 louder
changes master louder 20 || fail "a finger moves no slider"
finger begin 1 450 350
for step in $(seq 40); do
  finger move 1 $((450 + 20 * step)) $((350 - 6 * step))
  sleep 0.02
done
finger end 1
sleep 0.6
number 106 after
stays louder after 5 || fail "a stroke that ran off the cloth moved a slider"
# A slider under one finger while another feels.
number 134 low
finger begin 1 1235 145
finger begin 2 450 350
for step in $(seq 20); do
  finger move 1 $((1235 + step)) 145
  finger move 2 $((450 + 4 * (step % 10))) 350
  sleep 0.03
done
sleep 0.5
finger end 2
finger end 1
sleep 0.6
number 134 low-later
changes low low-later 20 || fail "no slider moves under one finger while another feels"
part pane 350x170+710+550
tap 800 539
part pane-later 350x170+710+550
changes pane pane-later 2000 || fail "a tap chooses no pane"
shot panes
# Two fingers that go apart feel; they do not magnify.
part ruler 420x20+240+68
finger begin 1 400 300
finger begin 2 440 300
for step in $(seq 25); do
  finger move 1 $((400 - 3 * step)) 300
  finger move 2 $((440 + 3 * step)) 300
  sleep 0.02
done
sleep 0.3
part ruler-later 420x20+240+68
shot apart
finger end 1
finger end 2
sleep 0.4
stays ruler ruler-later 400 || fail "two fingers that feel magnify the workspace"
stop

echo "$story: at twice the size"
export WINIT_X11_SCALE_FACTOR=2
start --stage
finger begin 1 440 250
rub 3 1 440 250 &
sleep 1.5
shot twice
wait $!
finger end 1
sleep 0.5
stop
visit | awk -F , '{ exit !($5 == "touch" && $8 >= 1 && $9 + $10 + $11 == 0 && $12 == 1) }' ||
  fail "a finger on the first cloth: $(visit)"
