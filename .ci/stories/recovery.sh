# A gain that was changed and never saved survives SIGKILL: it is offered and restored.
source "$(dirname "$0")/lib.sh"
display
start
slowly "mousemove 1247 112" "mousedown 1" "mousemove 1225 112" "mousemove 1215 112" "mouseup 1"
is_kept() { grep -q 'master gain' "$work"/state/selvedge/unsaved/*/work.json 2> /dev/null; }
await 20 is_kept || fail "the step was not kept"
crash
work_file=$(ls "$work"/state/selvedge/unsaved/*/work.json)
start
shot offer
# The last but two of the buttons at the right end of the line below the header.
slowly "mousemove 1232 62" "click 1"
# It stays on disk until it is written anew.
await 20 test ! -e "$work_file" || fail "it was not taken up"
shot restored
slowly "key ctrl+shift+s"
answer "$work/restored.scene.toml"
grep -q '^gain_db = -' "$work/restored.scene.toml" || fail "the gain is not as it was"
grep -q '^gain_db = -2.0$' "$work/restored.scene.toml" && fail "the gain is the default one"
stop
[ -z "$(ls "$work/state/selvedge/unsaved" 2> /dev/null)" ] || fail "saved work is still kept"
