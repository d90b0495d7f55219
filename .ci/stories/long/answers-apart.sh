#!/usr/bin/env bash
# Every key that a participant's screen prints, pressed in the participant's own window.
where=apart
. "$(dirname "$0")/answers.sh"
