#!/bin/sh
# A thousand listeners on one mesh: what they cost, and how long an edit takes to reach them all.
#
#   events.sh HEDGED LISTENERS_PROGRAM [LISTENERS [ROUNDS]]
set -eu
hedged=$1 program=$2 listeners=${3:-1000} rounds=${4:-100}
. "$(dirname "$0")/daemon.sh"
daemon_start "$hedged"
"$program" "${base##*:}" "$daemon" "$listeners" "$rounds"
