#!/usr/bin/env bash
# A whole study of eight by real keys, about ten minutes, told when it is asked for and not with the others:
#
#   SELVEDGE_SHOTS=FOLDER bash .ci/stories/long/eight.sh PROGRAM
#
# Eight participants in turn take part in a study of triads on the emulator; then the board has them all, what is
# missing, and the analysis says its answer. Their logs verify.
. "$(dirname "$0")/../lib.sh"
study=$work/study
mkdir -p "$XDG_CONFIG_HOME/selvedge" "$study"
cat > "$work/triads.toml" << 'DESIGN'
study = "s"
experiment = "triads"
title = "Three cloths, two alike"
medium = "array"
seed = 1
textiles = ["silk-crepe", "wool-twill", "jute-plain"]

[presentation]
kind = "places"
n = 3

[response]
kind = "choice"
confidence_words = ["easy", "normal", "hard"]
confidence_weights = [1.0, 0.5, 0.1]

[order]
sets = "triads"

[rules]
subjects = 8
DESIGN
cat > "$XDG_CONFIG_HOME/selvedge/settings.toml" << SETTINGS
sessions_folder = "$study"
experiment_design = "$work/triads.toml"
SETTINGS
# Trials that count: what was voided is presented again.
rows() {
  awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "valid") at = i } $2 == "trial" && $at == 1' "$log" | wc -l
}
has_rows() { [ "$(rows)" -ge "$1" ]; }
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
for nth in 1 2 3 4 5 6 7 8; do
  log=$study/s_triads_p0${nth}_1.csv
  start
  slowly 'key Escape' 'key ctrl+3'
  sleep 1
  slowly 'mousemove 1270 291' 'click 1' "type --delay 30 'p0$nth'" 'key Tab'
  shot "$nth-form"
  slowly 'mousemove 1150 449' 'click 1'
  sleep 1
  slowly 'mousemove 1126 218' 'click 1'
  await 60 test -s "$log" || fail "the session of p0$nth does not begin"
  sleep 1
  slowly 'mousemove 1235 691' 'click 1'
  sleep 3
  for trial in 1 2 3; do
    tries=0
    until has_rows $trial; do
      [ $((tries += 1)) -lt 8 ] || fail "p0$nth cannot answer trial $trial"
      # A device that disarmed itself, on a busy machine for one, is armed again.
      [ $tries = 1 ] || slowly 'mousemove 1235 682' 'click 1'
      feel
      answers=(1 2 3 2 3 1 3 2 1)
      slowly 'mousemove 400 300' "key ${answers[$(((nth * 3 + trial) % 9))]}" 'key n' 'key Return'
      sleep 1
      [ "$trial" = 2 ] && [ "$tries" = 1 ] && shot "$nth-trial"
    done
  done
  sleep 1
  shot "$nth-end"
  stop
done
"$selvedge" experiment verify "$study" || fail "the logs are not as they were written"
start
slowly 'key Escape' 'key ctrl+3' 'key ctrl+k' "type --delay 30 'Study board'" 'key Return'
sleep 2
shot board
slowly 'key ctrl+k' "type --delay 30 'Analysis'" 'key Return'
sleep 2
shot analysis
stop
"$selvedge" experiment analyse "$study" --out "$work/report" || fail "no analysis"
head -n 30 "$work/report"/*.md
cp -r "$study" "${SELVEDGE_SHOTS:-$work}/" || true
