#!/usr/bin/env bash
# Keys, words, clicks, drags and turns of the wheel drawn by chance, while an array is armed: the program never
# breaks. Says how its memory grew, and how many ticks of the armed device it missed, by its own recordings.
#
# random.sh PROGRAM [SECONDS]     40 s unless said; SELVEDGE_SEED draws others
. "$(dirname "$0")/lib.sh"
seconds=${2:-40}
RANDOM=${SELVEDGE_SEED:-1}
# What is typed may name files: they are made here and nowhere else.
export HOME=$work/home
mkdir -p "$HOME"
cd "$HOME"
# Where the window shows the port and Arm.
port='1180 497'
arm='1230 449'
modifiers=('' '' '' '' shift+ ctrl+ ctrl+ ctrl+shift+ alt+)
keys=(a b c d e f g h i j k l m n o p q r s t u v w x y z 0 1 2 3 4 5 6 7 8 9 F1 F2 F5 F6 F10 F11 Tab Return Escape
  space Delete BackSpace Up Down Left Right Home End Prior Next comma period plus minus slash)
words=(7 -12.5 1e308 wool record µ–ß ../../x 'all off' close)

one_of() { local -n all=$1; echo "${all[RANDOM % ${#all[@]}]}"; }
somewhere() { echo "$((RANDOM % 1400)) $((RANDOM % 900))"; }
act() {
  case $((RANDOM % 24)) in
    [0-8]) xdotool key "$(one_of modifiers)$(one_of keys)" ;;
    9 | 10) xdotool type "$(one_of words)" ;;
    11 | 12 | 13) xdotool mousemove $(somewhere) click $((1 + RANDOM % 3)) ;;
    14 | 15 | 16) xdotool mousemove $(somewhere) mousedown 1 mousemove $(somewhere) mousemove $(somewhere) mouseup 1 ;;
    17 | 18) xdotool mousemove $(somewhere) click $((4 + RANDOM % 4)) ;;
    19 | 20 | 21) xdotool mousemove $(somewhere) ;;
    # Else what asks for an answer, and everything off, would get all the rest.
    22) xdotool key Escape ;;
    # Armed again, by its name, and recorded.
    23) slowly 'key Escape' 'key ctrl+k' "type 'Arm the device'" 'key Return' 'key r' ;;
  esac
}

memory_mb() { awk -v name="$1:" '$1 == name { printf "%d", $2 / 1000 }' "/proc/$program/status"; }
is_over() { ! kill -0 "$program" 2> /dev/null; }
connect() {
  slowly "mousemove $port" 'click 1' "type --delay 30 '$work/array'" 'key Return'
  await 20 grep -q READY "$work/device.csv" || fail "the device was never found"
  sleep 1
  slowly "mousemove $arm" 'click 1' 'key r'
}
# The program may have been told to close: it ends well, and is begun again.
begin_again() {
  local code=0
  wait "$program" || code=$?
  program=
  [ "$code" = 0 ] || fail "exit code $code after $n_acts acts"
  n_ends=$((n_ends + 1))
  start
  slowly 'key ctrl+k' "type 'Connect to the emulator'" 'key Return'
}

display
"$selvedge" bridge emulate --link "$work/array" --log "$work/device.csv" > /dev/null 2>&1 &
device=$!
start
connect
n_acts=0
n_ends=0
over_time_mb=$(memory_mb VmRSS)
n_tenths=0
from_s=$SECONDS
until_s=$((SECONDS + seconds))
while [ "$SECONDS" -lt "$until_s" ]; do
  act 2> /dev/null || true
  n_acts=$((n_acts + 1))
  if is_over; then
    begin_again
    over_time_mb+=" closed $(memory_mb VmRSS)"
    continue
  fi
  # Memory after every tenth of the time.
  if [ $((10 * (SECONDS - from_s) / seconds)) -gt "$n_tenths" ]; then
    n_tenths=$((n_tenths + 1))
    over_time_mb+=" $(memory_mb VmRSS)"
  fi
done
peak_mb=$(memory_mb VmHWM)
shot end
! grep -q panicked "$work/err.txt" || fail "it panicked"
xdotool windowfocus "$window" 2> /dev/null || true
stop
# Of ticks that follow one another on the armed device, those that no row tells of.
tables=$(ls "$work"/data/selvedge/recordings/*/ticks.csv 2> /dev/null) || true
[ -n "$tables" ] || fail "nothing was recorded in $n_acts acts"
missed=$(awk -F, 'FNR == 1 { last = ""; next }
  { n++; if ($8 != "") { armed++; if (last != "" && $2 == tick + 1) missed += $8 - last - 1 } last = $8; tick = $2 }
  END { printf "%d, of %d on the device and %d recorded", missed, armed, n }' $tables)
echo "$n_acts acts in $seconds s, $n_ends of them closed the window; ticks missed: $missed"
echo "memory in MB over the time: $over_time_mb; $peak_mb at most"
[ "$peak_mb" -lt 1000 ] || fail "$peak_mb MB of memory"
