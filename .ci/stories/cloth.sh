#!/usr/bin/env bash
# Cloth on a graphics card is as even as the software rasteriser has it: a fine twill seen from afar
# shows no arcs that it does not have.
. "$(dirname "$0")/lib.sh"
command -v convert > /dev/null && command -v import > /dev/null || { echo "no ImageMagick"; exit 0; }
cat > "$work/wool.scene.toml" << 'SCENE'
name = "Wool"
size_mm = [260.0, 260.0]

[[textile]]
id = "wool-twill"
origin_mm = [0.0, 0.0]
size_mm = [260.0, 260.0]
SCENE
# How uneven the cloth is in the upper left of the workspace: deviation over mean of its greys.
unevenness() {
  convert "$1" -crop 150x90+420+150 +repage -colorspace gray -blur 0x1.5 \
    -format '%[fx:standard_deviation/mean]' info:
}
display
start "$work/wool.scene.toml"
# The display is led out of the way, and its trail has time to fade.
slowly 'mousemove 420 520'
sleep 2
import -window root "$work/card.png"
shot card
"$selvedge" screenshot "$work/wool.scene.toml" --out "$work/software.png"
card=$(unevenness "$work/card.png")
software=$(unevenness "$work/software.png")
echo "unevenness: card $card, software $software"
awk -v card="$card" 'BEGIN { exit !(card > 0.005 && card < 0.03) }' \
  || fail "the cloth on the card is uneven: $card (software: $software)"
stop
