#!/bin/sh
# Measures a thousand listeners of one mesh: the memory that they take, and the time until an edit
# has reached all of them.
#
#   events.sh HEDGED LISTENERS_PROGRAM [LISTENERS [ROUNDS]]
set -eu
hedged=$1 program=$2 listeners=${3:-1000} rounds=${4:-100}
. "$(dirname "$0")/daemon.sh"
daemon_start "$hedged"
"$program" "${base##*:}" "$daemon" "$listeners" "$rounds"
