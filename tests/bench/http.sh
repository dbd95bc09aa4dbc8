#!/bin/sh
# Measures the requests a second, and the processor time of a request, of hedged and of a bare
# libmicrohttpd program that sends the same bytes and headers, in turn and in one run: each server
# has one worker, wrk has one thread and 64 connections.
#
# It also measures what checking a token and counting a request cost by themselves (checks.c), and how
# long the geometry of 164,025 vertices takes in each content coding, with the client on the same machine.
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
guard=$!
others=$guard
exec 5<"$work/guarded"
while read -r line <&5; do
    case $line in *"listening on "*) guarded=${line##*listening on }; break ;; esac
done
cat <&5 >/dev/null &
others="$others $!"
curl -sf -o /dev/null -H "$bearer" -H 'Content-Type: application/json' \
    "$guarded/v1/meshes?id=bench" -d '{"shape":"icosphere","subdivisions":4}'

# The bare program sends the headers of the answer, without those that libmicrohttpd adds.
curl -sf -o /dev/null -D - "$element" | tr -d '\r' |
    grep -v -e '^HTTP/' -e '^Date:' -e '^Content-Length:' -e '^$' >"$work/headers"
set --
while IFS= read -r line; do set -- "$@" "$line"; done <"$work/headers"
"$bare" 1 "$(curl -sf "$element")" "$@" <"$work/stdin" >"$work/port" &
peer_process=$!
others="$others $peer_process"
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

# Prints the processor time in nanoseconds that the threads of a process have used.
used() { cat "/proc/$1/task/"*/schedstat | awk '{ s += $1 } END { printf "%.0f\n", s }'; }

# load NAME PROCESS ARGUMENTS...: adds a line with the rate and the microseconds a request to NAME
load() {
    name=$1 process=$2
    shift 2
    before=$(used "$process")
    wrk -t1 -c64 -d"${seconds}s" "$@" >"$work/wrk"
    awk -v before="$before" -v after="$(used "$process")" '/requests in/ { n = $1 }
        /Requests\/sec/ { r = $2 } /Non-2xx/ { bad = 1 }
        END { if (bad || !r) exit 1; print r, (after - before) / 1000 / n }' "$work/wrk" \
        >>"$work/$name"
}

i=0
while [ $i -lt "$rounds" ]; do
    load bare "$peer_process" "http://127.0.0.1:$port/"
    load element "$daemon" "$element"
    load token-element "$guard" -H "$bearer" "$guarded${element#"$base"}"
    load adjacency "$daemon" "$adjacency"
    load token-adjacency "$guard" -H "$bearer" "$guarded${adjacency#"$base"}"
    load edit "$daemon" -s "$work/edit.lua" "$base/v1/meshes/bench/edits"
    i=$((i + 1))
done

# median NAME COLUMN
median() { cut -d' ' -f"$2" "$work/$1" | sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }
peer=$(median bare 1)
peer_time=$(median bare 2)
row() {
    awk -v name="$1" -v ours="$(median "$2" 1)" -v time="$(median "$2" 2)" -v peer="$peer" \
        -v peer_time="$peer_time" -v target="$3" 'BEGIN {
        rate = ours / peer
        spent = peer_time / time
        printf "%-28s %8.0f req/s %6.2f us   %.2f of bare by rate, %.2f by time   target %.2f   %s\n",
            name, ours, time, rate, spent, target,
            (rate >= target && spent >= target ? "met" : "falls short") }'
}
echo "medians of $rounds runs of $seconds s; access log on"
printf '%-28s %8.0f req/s %6.2f us\n' "bare libmicrohttpd" "$peer" "$peer_time"
row "GET an element" element 0.7
row "GET an element, token" token-element 0.7
row "GET an adjacency" adjacency 0.7
row "GET an adjacency, token" token-adjacency 0.7
row "POST an edit" edit 0.5
curl -sf -o /dev/null -H 'Content-Type: application/json' "$base/v1/meshes?id=large" \
    -d '{"shape":"torus","major_segments":405,"minor_segments":405}'
i=0
while [ $i -lt $((3 * rounds)) ]; do
    for coding in identity gzip zstd; do
        curl -sf -o /dev/null -H "Accept-Encoding: $coding" -w '%{time_total} %{size_download}\n' \
            "$base/v1/meshes/large/geometry" >>"$work/$coding"
    done
    i=$((i + 1))
done
for coding in identity gzip zstd; do
    awk -v name="geometry, $coding" -v time="$(median $coding 1)" -v plain="$(median identity 1)" \
        -v size="$(median $coding 2)" 'BEGIN {
        printf "%-28s %8.1f ms %9d bytes   %.2f of identity   target 2.00   %s\n", name, time * 1000, size,
            time / plain, (time <= 2 * plain ? "met" : "falls short") }'
done
"$checks" >"$work/checks"
awk -v get="$(median element 1)" '
function row(name, value, unit, target) {
    printf "%-28s %8.2f %-12s target %.2f   %s\n", name, value, unit, target,
        (value <= target ? "met" : "falls short")
}
$1 == "token" { row("a check of a token", $2, "us", 1) }
$1 == "metrics" { row("metrics", $2 * get / 1e4, "% of a GET", 2) }' "$work/checks"
# For each request both servers read and write once, and do no other system call.
cat <<'NOTE'
What hedged does for a GET beyond the bare program: checks of every byte, admission, the element
with its shortest doubles, and the access log, whose thread shares the cores.
NOTE
