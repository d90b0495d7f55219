#!/usr/bin/env bash
# In the middle of a visit the array's cable is pulled and the server of sound is killed: the stage goes on, the visit
# is whole on disk, and both are taken up again when they are back.
. "$(dirname "$0")/lib.sh"
display 1280x720
log=$work/data/selvedge/stage
mkdir -p "$XDG_CONFIG_HOME/selvedge"
printf 'pin = "271828"\nport = "%s"\n' "$work/array" > "$XDG_CONFIG_HOME/selvedge/stage.toml"
plug() {
  "$selvedge" bridge emulate --link "$work/array" --log "$work/device-$1.csv" > /dev/null 2>&1 &
  device=$!
}
is_ready() { grep -q READY "$work/device-$1.csv" 2> /dev/null; }
sound=
trap 'kill $program $device $sound $server 2> /dev/null || true; rm -rf "$work"' EXIT
export PULSE_SERVER=unix:$work/native HOME=$work
serve() {
  rm -f "$work/native"
  pulseaudio -n --daemonize=no --use-pid-file=no --exit-idle-time=-1 --disallow-exit=yes \
    -L 'module-null-sink sink_name=null' \
    -L "module-native-protocol-unix auth-anonymous=1 socket=$work/native" > "$work/sound.txt" 2>&1 &
  sound=$!
  await 20 test -S "$work/native" || fail "no server of sound: $(cat "$work/sound.txt")"
}
is_heard() { [ -n "$(pactl list short sink-inputs 2> /dev/null)" ]; }
has_sound() { command -v pulseaudio > /dev/null && command -v pactl > /dev/null; }
has_sound || echo "$story: pulseaudio or pactl is not installed: the server of sound is left out"
plug 1
has_sound && serve
start --stage
await 20 is_ready 1 || fail "the array was not found"
has_sound && { await 20 is_heard || fail "nothing is heard"; }
pull() { kill -KILL "$1" && { wait "$1" 2> /dev/null || true; }; }
goes_on() { kill -0 "$program" 2> /dev/null || fail "it ended: $1"; }
stroke 440 150
# The cable, while a finger is on the cloth.
xdotool mousemove 440 150 mousedown 1
pull "$device"
device=
stroke 460 150
goes_on "the cable was pulled"
look resting
if has_sound; then
  pull "$sound"
  sound=
fi
stroke 700 150
goes_on "the server of sound was killed"
shot resting
# A frame is still drawn for a touch.
differs resting 200 || fail "nothing is drawn any more"
plug 2
await 30 is_ready 2 || fail "the array was not taken up again"
if has_sound; then
  serve
  await 30 is_heard || fail "sound was not taken up again"
fi
stroke 440 420
goes_on "both came back"
grep -q 'ARMED' "$work"/device-*.csv && fail "nobody permitted arming"
has_row() { [ "$(tail -n +2 "$log/visits.csv" | wc -l)" = 1 ]; }
await 60 has_row || fail "not one visit: $(cat "$log/visits.csv")"
tail -n 1 "$log/visits.csv" | grep -q ',mouse,.*,idle$' || fail "$(cat "$log/visits.csv")"
stop
