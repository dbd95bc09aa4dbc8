#!/bin/sh
# A thousand clients who take an answer at 6 bytes a second (slowhttptest -X): what others wait for
# beside them, what they make the daemon hold, and when the last of them is closed.
#
#   slow.sh HEDGED [CLIENTS [SIDE]]
#
# They ask for SIDE x SIDE quads as OBJ: 200 is more than a socket keeps, 30 is less. Others read a
# vertex through 8 connections. The first row is of the daemon alone.
set -eu
hedged=$1 clients=${2:-1000} side=${3:-200}
for program in slowhttptest wrk curl ss; do
    command -v $program >/dev/null || { echo "slow.sh: $program is not installed" >&2; exit 1; }
done
. "$(dirname "$0")/daemon.sh"
daemon_start "$hedged" --log off
curl -s -o "$work/made" -X PUT -H 'Content-Type: application/json' \
    -d "{\"shape\":\"grid\",\"columns\":$side,\"rows\":$side}" "$base/v1/meshes/m"

row() {
    wrk -t1 -c8 -d2s --latency "$base/v1/meshes/m/vertices/0" >"$work/wrk"
    open=$(ss -tnH state established "( sport = :${base##*:} )" | wc -l)
    memory=$(curl -s "$base/v1/meshes" | sed 's/.*"memory_bytes":\([0-9]*\).*/\1/')
    awk -v seconds="$1" -v open="$open" -v memory="$memory" '
        /99%/ { p99 = $2 } /Requests\/sec/ { rate = $2 }
        END { printf "%7s %6d %10s %10d %8.1f\n", seconds, open, p99, rate, memory / 1048576 }
    ' "$work/wrk"
}

printf '%7s %6s %10s %10s %8s\n' seconds open p99 requests/s MiB
row alone
slowhttptest -X -c "$clients" -r "$clients" -w 512 -y 1024 -n 5 -z 32 -l 20 -p 3 \
    -u "$base/v1/meshes/m/content?format=obj" >"$work/slow" 2>&1 &
others=$!
began=$(date +%s)
open=1
until [ "$open" -eq 0 ]; do
    row $(($(date +%s) - began))
done
