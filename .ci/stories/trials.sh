#!/usr/bin/env bash
# A session in the main window by real keys: it is asked for, its trial waits for the array, is answered
# by the keys that it prints, is voided with the array and presented again, and its log is whole.
. "$(dirname "$0")/lib.sh"
study=$work/study
mkdir -p "$XDG_CONFIG_HOME/selvedge" "$study"
cat > "$work/triads.toml" << 'DESIGN'
study = "s"
experiment = "triads"
medium = "array"
seed = 1
textiles = ["silk-crepe", "wool-twill", "jute-plain"]
[odd_one_out]
DESIGN
cat > "$XDG_CONFIG_HOME/selvedge/settings.toml" << SETTINGS
sessions_folder = "$study"
experiment_design = "$work/triads.toml"
SETTINGS
log=$study/s_triads_p01_1.csv
rows() { column trial | wc -l; }
has_rows() { [ "$(rows)" -ge "$1" ]; }
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i } $2 == "trial" { print $at }' "$log"; }
# The finger goes to and fro over all three fabrics.
feel() {
  for x in 150 480 820; do
    moves=()
    for step in $(seq 0 160); do
      moves+=(mousemove $((x + step % 80)) $((330 + step)) sleep 0.012)
    done
    xdotool "${moves[@]}"
  done
}
display
start
slowly 'key Escape' 'key ctrl+3'
sleep 1
# The pseudonym, then the button that says what will be written.
slowly 'mousemove 1270 291' 'click 1' "type --delay 30 'p01'" 'key Tab'
sleep 0.5
shot form
slowly 'mousemove 1150 449' 'click 1'
sleep 1
shot asked
[ ! -e "$log" ] || fail "it is written before it was asked"
slowly 'mousemove 1126 218' 'click 1'
await 60 test -s "$log" || fail "the session does not begin"
sleep 1
shot waiting
[ "$(rows)" = 0 ] || fail "a trial was answered before it began"
slowly 'key 2' 'key e' 'key Return'
[ "$(rows)" = 0 ] || fail "keys answer what is not presented"
# Armed: the trial begins by itself, and waits until all three were felt.
slowly 'mousemove 1235 691' 'click 1'
sleep 3
shot begun
slowly 'mousemove 400 300' 'key 2' 'key e' 'key Return'
sleep 1
[ "$(rows)" = 0 ] || fail "an answer is taken before anything was felt"
feel
sleep 1
slowly 'key Return'
await 20 has_rows 1 || fail "the keys do not answer"
[ "$(column valid)" = 1 ] && [ "$(column proof)" = emulator ] || fail "the row is not of what was felt"
# The array is disarmed in the next: its row says so, and it comes again once the array is armed.
sleep 1
xdotool mousemove 200 350
sleep 0.5
slowly 'mousemove 1235 691' 'click 1'
await 20 has_rows 2 || fail "no row of what was voided"
[ "$(column valid | tail -n 1)" = 0 ] || fail "what was voided counts"
column void | tail -n 1 | grep -q 'armed' || fail "it is not said why"
sleep 1
shot voided
for nth in 1 2; do
  slowly 'mousemove 1235 691' 'click 1'
  sleep 3
  # Whoever is presented two in a row answers both.
  while ! has_rows $((2 + nth)); do
    feel
    slowly 'mousemove 400 300' 'key 3' 'key h' 'key Return'
    sleep 1
  done
  [ "$nth" = 2 ] || slowly 'mousemove 1235 691' 'click 1'
  sleep 1
done
shot end
