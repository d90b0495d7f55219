# What every story needs: a virtual display, the program on it, and hands. Sourced by a story, which
# then speaks in these words:
#
#   display [WIDTHxHEIGHT]      a display of its own
#   start [ARGUMENT…]           the program, its window found and focused
#   slowly 'key r' 'click 1'…   xdotool's words, slowly enough for software drawing
#   stroke X Y                  a finger goes to and fro on the cloth there, and lifts
#   await SECONDS COMMAND…      waits until the command succeeds
#   answer PATH                 answers the field that asks where to save, and waits for the file
#   shot NAME                   a screenshot, in the folder that SELVEDGE_SHOTS names, if it does
#   look NAME | differ A B      keeps what is on the screen; pixels in which two such pictures differ
#   differs A N | looks_like A N   whether what is on the screen differs from A in more, or in fewer pixels
#   crash | stop                SIGKILL; SIGTERM and a clean end
#   fail WHY                    ends the story
#
# Settings, own textiles and what is kept between runs lie in $work, which goes with the story.
set -euo pipefail
selvedge=$(realpath "$1")
story=$(basename "$0" .sh)
work=$(mktemp -d)
server=
program=
device=
trap 'kill $program $device $server 2> /dev/null || true; rm -rf "$work"' EXIT
export XDG_CONFIG_HOME=$work/config XDG_DATA_HOME=$work/data XDG_STATE_HOME=$work/state
export XDG_CACHE_HOME=$work/cache SELVEDGE_DIALOGS=field
unset WAYLAND_DISPLAY WAYLAND_SOCKET

fail() {
  echo "$story: $1"
  cat "$work/err.txt" 2> /dev/null || true
  shot failed
  exit 1
}

display() {
  # The server chooses a number that no other has.
  Xvfb -displayfd 3 -noreset -screen 0 "${1:-1400x900}x24" 3> "$work/display" > "$work/xvfb.log" 2>&1 &
  server=$!
  await 20 test -s "$work/display" || fail "no display"
  export DISPLAY=:$(cat "$work/display")
}

# Whoever has settings is not shown the tour; `is_first=1` starts without any.
start() {
  mkdir -p "$XDG_CONFIG_HOME/selvedge"
  [ -n "${is_first:-}" ] || [ -e "$XDG_CONFIG_HOME/selvedge/settings.toml" ] || echo 'theme = "system"' > "$XDG_CONFIG_HOME/selvedge/settings.toml"
  "$selvedge" "$@" > "$work/out.txt" 2> "$work/err.txt" &
  program=$!
  window=
  for _ in $(seq 300); do
    window=$(xdotool search --onlyvisible --name 'Selvedge' 2> /dev/null | head -n 1) || true
    [ -n "$window" ] && break
    kill -0 "$program" 2> /dev/null || fail "the program ended"
    sleep 0.1
  done
  [ -n "$window" ] || fail "no window came up"
  xdotool windowfocus "$window"
  await 30 is_drawn || fail "nothing is drawn"
  sleep 1
}

is_drawn() { [ "$(import -window root -format %k info:)" -gt 100 ]; }

slowly() {
  for step in "$@"; do
    eval "xdotool $step"
    sleep 0.4
  done
}

stroke() {
  xdotool mousemove "$1" "$2" mousedown 1
  for step in $(seq 20); do
    xdotool mousemove $(($1 + step % 4 * 25)) "$2"
    sleep 0.15
  done
  xdotool mouseup 1
}

await() {
  local until=$((SECONDS + $1))
  shift
  until "$@"; do
    [ "$SECONDS" -lt "$until" ] || return 1
    sleep 0.2
  done
}

answer() {
  slowly "key ctrl+a" "type --delay 30 '$1'" "key Return"
  await 10 test -s "$1" || fail "nothing was saved as $1"
}

shot() {
  [ -n "${SELVEDGE_SHOTS:-}" ] && command -v import > /dev/null || return 0
  mkdir -p "$SELVEDGE_SHOTS"
  import -window root "$SELVEDGE_SHOTS/$story-$1.png" 2> /dev/null || true
}

look() {
  import -window root "$work/look-$1.png"
}

differ() {
  compare -metric AE "$work/look-$1.png" "$work/look-$2.png" null: 2>&1 | sed 's/[^0-9.e+].*//' | xargs printf '%.0f\n' || true
}

differs() {
  look now
  [ "$(differ "$1" now)" -gt "$2" ]
}

looks_like() { ! differs "$1" "$2"; }

crash() {
  kill -KILL "$program"
  wait "$program" 2> /dev/null || true
  program=
}

stop() {
  kill -TERM "$program"
  for _ in $(seq 100); do
    kill -0 "$program" 2> /dev/null || break
    sleep 0.1
  done
  local code=0
  wait "$program" || code=$?
  program=
  [ "$code" = 0 ] || fail "exit code $code"
}
