#!/bin/sh
# Measures the requests a second of hedged and of a bare libmicrohttpd program that sends the same
# bytes, in turn and in one run: each server has one worker, wrk has one thread and 64 connections.
#
# It also measures what checking a token and counting a request cost by themselves (checks.c).
#
#   http.sh HEDGED BARE CHECKS [ROUNDS [SECONDS]]
set -eu
hedged=$1 bare=$2 checks=$3 rounds=${4:-5} seconds=${5:-3}
command -v wrk >/dev/null || { echo "http.sh: wrk is not installed" >&2; exit 1; }
. "$(dirname "$0")/daemon.sh"
mkfifo "$work/stdin" "$work/port"

# The access log is on, as it is by default.
daemon_start "$hedged" --workers 1
curl -sf -o /dev/null -H 'Content-Type: application/json' "$base/v1/meshes?id=bench" \
    -d '{"shape":"icosphere","subdivisions":4}'
element=$base/v1/meshes/bench/faces/1000
adjacency=$base/v1/meshes/bench/vertices/100/faces

# A second daemon requires tokens, and the requests carry one.
"$hedged" --new-token bench write >"$work/token"
tail -n 1 "$work/token" >"$work/tokens"
bearer="Authorization: Bearer $(head -n 1 "$work/token")"
mkfifo "$work/guarded"
"$hedged" --workers 1 --tokens "$work/tokens" --listen 127.0.0.1:0 --store memory \
    2>"$work/guarded" &
others=$!
exec 5<"$work/guarded"
while read -r line <&5; do
    case $line in *"listening on "*) guarded=${line##*listening on }; break ;; esac
done
cat <&5 >/dev/null &
others="$others $!"
curl -sf -o /dev/null -H "$bearer" -H 'Content-Type: application/json' \
    "$guarded/v1/meshes?id=bench" -d '{"shape":"icosphere","subdivisions":4}'

"$bare" 1 "$(curl -sf "$element")" <"$work/stdin" >"$work/port" &
others="$others $!"
exec 3>"$work/stdin"
read -r port <"$work/port"

cat >"$work/edit.lua" <<'LUA'
wrk.method = "POST"
wrk.headers["Content-Type"] = "application/json"
local n = 0
function request()
    n = n + 1
    return wrk.format(nil, nil, nil,
        '{"op":"vertex_move","vertex":' .. n % 2000 .. ',"to":[0,0,' .. n .. ']}')
end
LUA

load() {
    wrk -t1 -c64 -d"${seconds}s" "$@" | awk '/Requests\/sec/ { r = $2 } /Non-2xx/ { bad = 1 }
        END { if (bad || !r) exit 1; print r }'
}

i=0
while [ $i -lt "$rounds" ]; do
    load "http://127.0.0.1:$port/" >>"$work/bare"
    load "$element" >>"$work/element"
    load -H "$bearer" "$guarded${element#"$base"}" >>"$work/token-element"
    load "$adjacency" >>"$work/adjacency"
    load -s "$work/edit.lua" "$base/v1/meshes/bench/edits" >>"$work/edit"
    i=$((i + 1))
done

median() { sort -n "$work/$1" | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }
peer=$(median bare)
row() {
    awk -v name="$1" -v ours="$(median "$2")" -v peer="$peer" -v target="$3" 'BEGIN {
        ratio = ours / peer
        printf "%-28s %8.0f req/s   %.2f of bare   target %.2f   %s\n", name, ours, ratio, target,
            (ratio >= target ? "met" : "falls short") }'
}
echo "medians of $rounds runs of $seconds s; access log on"
printf '%-28s %8.0f req/s\n' "bare libmicrohttpd" "$peer"
row "GET an element" element 0.8
row "GET an element with a token" token-element 0.8
row "GET an adjacency" adjacency 0.8
row "POST an edit" edit 0.5
"$checks" >"$work/checks"
awk -v get="$(median element)" '
function row(name, value, unit, target) {
    printf "%-28s %8.2f %-12s target %.2f   %s\n", name, value, unit, target,
        (value <= target ? "met" : "falls short")
}
$1 == "token" { row("a check of a token", $2, "us", 1) }
$1 == "metrics" { row("metrics", $2 * get / 1e4, "% of a GET", 2) }' "$work/checks"
# For each request both servers call recvfrom once and sendmsg once, and nothing else; these two
# calls take two thirds of hedged's time.
cat <<'NOTE'
Not measured here: what hedged does for a GET beyond the bare program is six header fields for one,
admission, the element with its shortest doubles, and the access log, whose thread shares the cores.
NOTE
