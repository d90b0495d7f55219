#!/usr/bin/env bash
# Every key that a participant's screen prints, pressed for real: each kind of design is tried as a pilot, and the log
# says of every key whether it did what it says. The same in a window of the participant's own: answers-apart. Told when
# they are asked for: SELVEDGE_SHOTS=FOLDER bash .ci/stories/long/answers.sh PROGRAM
. "$(dirname "$0")/../lib.sh"
root=$(realpath "$(dirname "$0")/../../..")
where=${where:-within}
study=$work/study
four='textiles = ["silk-crepe", "wool-twill", "jute-plain", "denim"]'

# Whose pages are read first, and the middles of what lies there, in parts of the view; then its trials: keys, and
# what the log holds of them. `again` plays once more. The last key is repeated until it is taken.
asked() {
  cat << 'DESIGNS'
odd-one-out 1 .18,.43 .50,.43 .82,.43
1 e Return : response=1 grade=easy
2 n Return : response=2 grade=normal
3 h Return : response=3 grade=hard
ranking-virtual-target 3 .33,.21 .67,.21 .50,.43 .33,.65 .67,.65
2 1 BackSpace 3 1 4 Return : rank2=1 rank3=2 rank1=3 rank4=4
best-worst 0 .36,.24 .64,.24 .36,.60 .64,.60
1 2 BackSpace 4 Return : best=1 worst=4
3 2 Return : best=3 worst=2
same-different 0 .30,.40 .70,.40
s 1 Return : response=same confidence=1
d 2 Return : response=different confidence=2
s 3 Return : response=same confidence=3
d 4 Return : response=different confidence=4
abx 0 .18,.43 .50,.43 .82,.43
1 1 Return : response=1 confidence=1
2 2 Return : response=2 confidence=2
1 3 Return : response=1 confidence=3
roughness-intervals 1 .50,.55 .50,.55 .50,.55
1 : response=1
2 : response=2
preference 0 .30,.40 .70,.40
1 Return : response=1
2 Return : response=2
gain-yes-no 0
y Return : response=yes
n Return : response=no
real-or-generated 1
r 1 Return : response=real confidence=1
g 2 Return : response=generated confidence=2
r 3 Return : response=real confidence=3
masked-threshold 0
1 : response=1
2 : response=2
3 : response=3
free-sorting 0 .36,.24 .64,.24 .36,.60 .64,.60
space Tab space space Tab space Tab space Return : pile1=1 pile2=2 pile3=1 pile4=1
rating 1
Right Right Tab Left Tab Right Tab Left Left Return : rating_roughness=60 rating_hardness=45 rating_pleasantness=55 rating_strength=40
magnitude 1
1 2 3 4 again 5 6 7 8 9 0 period 5 Return : response=1234567890.5
adjustment-two-gains 1
Up Up Up Down Left Left Left Right Return : value_gain_40_db-start_gain_40_db=2 value_gain_320_db-start_gain_320_db=-2
gain-matching 1
Up Up Up Down Return : value_gain_db-start_gain_db=2
DESIGNS
}

# The value in the last row of a column, or of a difference of two.
value() {
  awk -F, -v OFMT=%.12g -v wanted="$1" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
    $2 == "trial" { n = split(wanted, names, "-"); found = $at[names[1]]; if (n > 1) found -= $at[names[2]] }
    END { if (found ~ /^[-0-9.]+$/) found += 0; print found }' "$log"
}
rows() { awk -F, '$2 == "trial"' "$log" | wc -l; }
has_rows() { [ "$(rows)" -ge "$1" ]; }
has_log() { log=$(ls "$study"/pilots/*.csv 2> /dev/null | grep -v participants) && [ -s "$log" ]; }
has_participants() { view=$(xdotool search --onlyvisible --name 'participant$' 2> /dev/null | head -n 1) && [ -n "$view" ]; }
press() { xdotool key "$1" sleep 0.25; }

begin() {
  local text=$root/assets/designs/$1.toml
  [ -e "$text" ] || text=$root/src/experiment/analysis/tests/designs/$1.toml
  rm -rf "$study"
  mkdir -p "$study" "$XDG_CONFIG_HOME/selvedge"
  sed -zE "s/textiles = \[([^]\"]*\"){9,}[^]]*\]/$four/; s/for_s = [0-9.]*/for_s = 0.5/g; s/reference = \"real-cloth\"//; s/interval_ms = 2000/interval_ms = 4000/" "$text" > "$work/$1.toml"
  cat > "$XDG_CONFIG_HOME/selvedge/settings.toml" << SETTINGS
sessions_folder = "$study"
experiment_design = "$work/$1.toml"
SETTINGS
  start
  slowly 'key Escape' 'key ctrl+3'
  # The button moves down with what is said of the design above it.
  local y
  for y in 449 435 463; do
    slowly "mousemove 1262 $y" 'click 1'
    await 6 has_log && break
  done
  await 30 has_log || fail "no pilot of $1 begins"
  area=(0 68 1070 806)
  if [ "$where" = apart ]; then
    slowly 'mousemove 1156 84' 'click 1'
    await 10 has_participants || fail "no window for the participant"
    xdotool windowmove "$view" 0 0 windowfocus "$view"
    area=(0 0 1000 860)
  fi
  sleep 0.5
  for _ in $(seq "$2"); do
    sleep 0.7
    press Return
  done
  sleep 0.5
}

# The finger goes to and fro over all that lies there, over each for more than a second.
feel() {
  local place x y moves
  for place in "$@"; do
    x=$(awk -v "p=$place" -v "o=${area[0]}" -v "w=${area[2]}" 'BEGIN { split(p, a, ","); printf "%d", o + a[1] * w }')
    y=$(awk -v "p=$place" -v "o=${area[1]}" -v "h=${area[3]}" 'BEGIN { split(p, a, ","); printf "%d", o + a[2] * h }')
    moves=()
    for step in $(seq 0 110); do
      moves+=(mousemove $((x - 30 + step % 60)) $((y - 20 + step % 40)) sleep 0.011)
    done
    xdotool "${moves[@]}"
  done
}

# One trial: its keys, the last until it is taken.
trial() {
  local design=$1 keys=$2 expected=$3 n last key pair
  shift 3
  n=$(($(rows) + 1))
  last=${keys##* }
  for key in ${keys%"$last"}; do
    if [ "$key" = again ]; then
      await 10 plays_again || fail "$design: Space plays nothing"
    else
      press "$key"
    fi
  done
  shot "$design-$n"
  for _ in 1 2 3 4 5 6; do
    feel "$@"
    press "$last"
    await 2 has_rows "$n" && break
  done
  has_rows "$n" || fail "$design: $keys does not answer"
  for pair in $expected; do
    [ "$(value "${pair%=*}")" = "${pair#*=}" ] || fail "$design: $keys gives ${pair%=*} $(value "${pair%=*}"), not ${pair#*=}"
  done
  sleep 0.5
}

# What is played lights up.
plays_again() {
  look still
  xdotool key space
  await 2 differs still 500
}

display
asked > "$work/asked"
design=
while read -r line <&4; do
  case $line in
    *:*) trial "$design" "$(echo "${line%%:*}" | xargs)" "${line#*: }" "${places[@]}" ;;
    *)
      [ -z "$design" ] || stop
      read -r design pages rest <<< "$line"
      read -r -a places <<< "${rest:-}"
      begin "$design" "$pages"
      shot "$design"
      ;;
  esac
done 4< "$work/asked"
stop
