# Three recordings, the third of them cut off by SIGKILL: all are listed at the next start.
source "$(dirname "$0")/lib.sh"
display
start
slowly "key r"
sleep 2
slowly "key r"
sleep 1
slowly "key r"
sleep 2
slowly "key r"
sleep 1
slowly "key r"
sleep 3
crash
folder=$work/data/selvedge/recordings
n=$(ls -d "$folder"/*Z* | wc -l)
[ "$n" = 3 ] || fail "$n recordings on disk instead of 3"
third=$(ls -td "$folder"/*Z* | head -n 1)
n_rows=$(wc -l < "$third/ticks.csv")
[ "$n_rows" -gt 60 ] || fail "only $n_rows rows of the recording that was cut off"
start
for name in 1 2 3; do
  grep -q "^name = \"Recording $name\"" "$folder"/*/recording.toml || fail "Recording $name is gone"
done
all_counted() { [ "$(grep -l '^ticks' "$folder"/*/recording.toml | wc -l)" = 3 ]; }
await 20 all_counted || fail "one was not listed"
slowly "mousemove 150 59" "click 1"
sleep 0.5
shot listed
stop
