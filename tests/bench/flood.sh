#!/bin/sh
# Measures clients that keep their rate, together with one that floods the daemon: how long the
# first ones wait, and how the flooding one is answered.
#
#   flood.sh HEDGED PACED [SECONDS]
#
# A calm token requests a vertex 500 times a second over 8 connections, which its rate allows. A
# second token, which may also send 500 requests a second, sends 5,000 over 64 connections: the rest
# is refused with 429 and the number of seconds to wait. Then the measurement is repeated together
# with 10,000 connections that were used once and are idle, and at last also with 1,000 clients that
# read the OpenAPI document, for which no token is needed, at 6 bytes a second (slowhttptest -X).
# In the first rows the calm client is alone; the best of three counts. Beside others its 99th
# percentile may be twice as long, or 2 ms longer, whichever is more. A machine that stops for some
# milliseconds now and then does so in any row, so a row beyond that is measured again, three times
# at most; a daemon that is kept from its work would be late each time. If it is, the exit status
# is 1.
#
# The flood and the slow clients run only when nothing else wants to: they stand for other machines, and
# would otherwise take the processor from the daemon and the calm client for milliseconds at a time
# (slowhttptest keeps a processor busy even after all its connections are closed). The table shows
# that the flood sends what it should, and the script waits for all slow connections.
set -eu
hedged=$1 paced=$2 seconds=${3:-8}
for program in slowhttptest curl ss; do
    command -v $program >/dev/null || { echo "flood.sh: $program is not installed" >&2; exit 1; }
done
. "$(dirname "$0")/daemon.sh"

# new NAME ROLE LIMITS: adds a line to the file of tokens; $work/NAME gets the token itself
new() {
    "$hedged" --new-token "$1" "$2" >"$work/said"
    sed -n 1p "$work/said" >"$work/$1"
    sed -n "2s/\$/ $3/p" "$work/said" >>"$work/tokens"
}
new calm write requests=100000
new flood read requests=500
calm=$(cat "$work/calm")
ulimit -n "$(ulimit -H -n)"
daemon_start "$hedged" --log off --tokens "$work/tokens" --limit-burst 1 --max-connections 15000 \
    --idle-timeout 600
curl -s -o "$work/made" -X PUT -H 'Content-Type: application/json' -H "Authorization: Bearer $calm" \
    -d '{"shape":"grid","columns":200,"rows":200}' "$base/v1/meshes/m"
port=${base##*:}
path=/v1/meshes/m/vertices/0

# await COUNT PROCESS: waits until the daemon has so many connections, which PROCESS opens
await() {
    until [ "$(ss -tnH state established "( sport = :$port )" | wc -l)" -ge "$1" ]; do
        kill -0 "$2" 2>/dev/null || { echo "flood.sh: fewer than $1 connections came" >&2; exit 1; }
        sleep 0.1
    done
}

# measure NAME FLOODS: prints a row; fails if the calm client waited longer than allowed
measure() {
    if [ "$2" = yes ]; then
        chrt --idle 0 "$paced" "$port" $path "$(cat "$work/flood")" 5000 64 "$seconds" 0 >"$work/flooded" 4<&- &
        flood=$!
        others="$others $flood"
    fi
    "$paced" "$port" $path "$calm" 500 8 "$((seconds - 1))" 0 >"$work/waited" 4<&-
    [ "$2" != yes ] || wait "$flood"
    [ "$2" = yes ] || echo 0 0 0 0 0 0 >"$work/flooded"
    cat "$work/waited" "$work/flooded" | tr '\n' ' ' |
        awk -v name="$1" -v rows="$work/rows" '{
            quiet = $5
            while ((getline line < rows) > 0) if (line < quiet) quiet = line
            if ($7 + $8 == 0) print $5 >>rows
            allowed = quiet + 2 > 2 * quiet ? quiet + 2 : 2 * quiet
            verdict = $5 > allowed ? "MORE THAN ALLOWED" : "ok"
            if ($2 + $3 > 0) verdict = "CALM CLIENT REFUSED"
            if ($8 != $12 || $9 > 0) verdict = "FLOOD NOT REFUSED AS IT SHOULD BE"
            printf "%-24s %6d %8.2f %8.2f %8.2f %7.1f %7d %7d  %s\n", name, $1, $4, $5, allowed,
                $5 / quiet, $7, $8, verdict
        }' >"$work/row"
    cat "$work/row"
    grep -q ' ok$' "$work/row"
}

# Connects 1,000 clients that read slowly, which the daemon closes after some seconds.
slow_clients() {
    chrt --idle 0 slowhttptest -X -c 1000 -r 1000 -w 512 -y 1024 -n 5 -z 32 -l 60 -p 3 \
        -u "$base/v1/openapi.json" >"$work/slowly" 2>&1 4<&- &
    slow=$!
    others="$others $slow"
    await 10900 "$slow"
}

# row NAME BEFORE: measures beside the flood until the calm client waits no longer than allowed; the
# command BEFORE runs before each measurement
row() {
    for _ in 1 2 3; do
        "$2"
        if measure "$1" yes; then
            return
        fi
        kill "$slow" 2>/dev/null || :
    done
    exit 1
}

slow=
printf '%-24s %6s %8s %8s %8s %7s %7s %7s\n' beside answers 'p50 ms' 'p99 ms' allowed 'x quiet' \
    flood:200 429
for _ in 1 2 3; do
    measure nobody no
done
row 'a flood' :
"$paced" "$port" $path "$calm" 1 1 600 10000 >"$work/idlers" 4<&- &
others="$others $!"
await 10000 $!
row '... and 10,000 idle' :
row '... and 1,000 slow' slow_clients
