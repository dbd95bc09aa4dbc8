#!/bin/sh
# Measures how often a second a mesh of 50,176 vertices can be bent while one of them is dragged, as
# the page does it: drag.mjs says what is sent.
#
#   drag.sh HEDGED [STEPS]
set -eu
hedged=$1 steps=${2:-60}
. "$(dirname "$0")/daemon.sh"
daemon_start "$hedged" --log off
node "$(dirname "$0")/drag.mjs" "$base" "$steps"
