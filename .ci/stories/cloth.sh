#!/usr/bin/env bash
# Cloth on a graphics card is what the software rasteriser draws, pixel by pixel: a fine twill seen from
# afar shows no arcs that it does not have.
. "$(dirname "$0")/lib.sh"
cat > "$work/wool.scene.toml" << 'SCENE'
name = "Wool"
size_mm = [260.0, 260.0]

[[textile]]
id = "wool-twill"
origin_mm = [0.0, 0.0]
size_mm = [260.0, 260.0]
SCENE
# The left part of the cloth, without the display and the label.
part() { convert "$1" -crop 230x350+262+112 +repage -depth 8 "$work/part-$2.png"; }
# How uneven it is: deviation over mean of its greys.
unevenness() {
  convert "$work/part-$1.png" -colorspace gray -blur 0x1.5 \
    -format '%[fx:standard_deviation/mean]' info:
}
# Pixels that differ by more than 12 of 255 in a colour, of a thousand; the largest difference of greys
# that are blurred, of 255; and where the differing pixels lie.
differences() {
  local n
  n=$(compare -metric AE -fuzz 4.7% "$work/part-card.png" "$work/part-software.png" null: 2>&1) || true
  awk -v n="$n" 'BEGIN { printf "%.2f ", n / 80.5 }'
  convert "$work/part-card.png" "$work/part-software.png" -colorspace gray -blur 0x1.5 \
    -compose difference -composite -format '%[fx:255*maxima] ' info:
  convert "$work/part-card.png" "$work/part-software.png" -compose difference -composite \
    -colorspace gray -threshold 3% -format '%@' info: 2> /dev/null || true
}
display
start "$work/wool.scene.toml"
# The display is led out of the part that is compared, but stays on the cloth: one that is not under it
# is drawn paler. Its trail has time to fade.
slowly 'key Escape' 'mousemove 600 450'
sleep 2
import -window root "$work/card.png"
shot card
"$selvedge" screenshot "$work/wool.scene.toml" --out "$work/software.png"
part "$work/card.png" card
part "$work/software.png" software
for drawn in card software; do
  uneven=$(unevenness "$drawn")
  echo "unevenness by $drawn: $uneven"
  awk -v uneven="$uneven" 'BEGIN { exit !(uneven > 0.005 && uneven < 0.03) }' || fail "the cloth is uneven by $drawn"
done
# Measured: none. A card that reads the cloth without halved copies shows arcs all over it.
read -r permille blurred where <<< "$(differences)"
echo "card against software: $permille ‰ of the pixels differ, $blurred when blurred, $where"
awk -v permille="$permille" 'BEGIN { exit !(permille <= 10) }' || fail "the card draws other cloth than the software"
stop
