#!/bin/sh
# A thousand listeners on one mesh: what they cost, and how long an edit takes to reach them all.
#
#   events.sh HEDGED LISTENERS_PROGRAM [LISTENERS [ROUNDS]]
set -eu
hedged=$1 program=$2 listeners=${3:-1000} rounds=${4:-100}
work=$(mktemp -d)
mkfifo "$work/log"
daemon= drain=
trap 'kill $daemon $drain 2>/dev/null || :; rm -rf "$work"' EXIT INT TERM

"$hedged" --listen 127.0.0.1:0 2>"$work/log" &
daemon=$!
exec 4<"$work/log"
base=
while [ -z "$base" ] && read -r line <&4; do
    case $line in *"listening on "*) base=${line##*listening on } ;; esac
done
cat <&4 >/dev/null &
drain=$!
"$program" "${base##*:}" "$daemon" "$listeners" "$rounds"
