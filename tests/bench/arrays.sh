#!/bin/sh
# Measures how long a Python program takes to read the positions of a million vertices into a numpy
# array, and to write them back, over loopback and with meshes in memory: arrays.py. It is run by
# Debian's Python, which has Debian's numpy.
#
#   arrays.sh HEDGED [ROUNDS]
set -eu
hedged=$1 rounds=${2:-9}
. "$(dirname "$0")/daemon.sh"
daemon_start "$hedged"
/usr/bin/python3 -B "$(dirname "$0")/arrays.py" "$base" "$rounds"
