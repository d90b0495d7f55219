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
# The largest difference of two pictures, of 255: of a colour, and of greys that are blurred.
differences() {
  compare -metric PAE "$work/part-card.png" "$work/part-software.png" null: 2>&1 |
    sed 's/.*(\(.*\)).*/\1/' | awk '{ printf "%.1f ", 255 * $1 }' || true
  convert "$work/part-card.png" "$work/part-software.png" -colorspace gray -blur 0x1.5 \
    -compose difference -composite -format '%[fx:255*maxima]' info:
}
display
start "$work/wool.scene.toml"
# The display is led out of the way, and its trail has time to fade.
slowly 'key Escape' 'mousemove 420 520'
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
# Measured: 3 and 1.5. A card that reads the cloth without halved copies shows arcs: 63 and 18.
read -r colour blurred <<< "$(differences)"
echo "card against software: $colour of 255 at most, $blurred when blurred"
awk -v colour="$colour" -v blurred="$blurred" 'BEGIN { exit !(colour <= 12 && blurred <= 5) }' ||
  fail "the card draws other cloth than the software"
stop
