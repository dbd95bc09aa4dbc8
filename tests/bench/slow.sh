#!/bin/sh
# Measures a thousand clients that read an answer at 6 bytes a second (slowhttptest -X): how long
# other clients wait meanwhile, how much memory the daemon holds, and when the last slow client is
# closed.
#
#   slow.sh HEDGED BARE [CLIENTS [SIDE]]
#
# The slow clients request SIDE x SIDE quads as OBJ: for 200 that is more than a socket's buffer
# holds, for 30 less. Other clients read a vertex through 8 connections. The first row is of the
# daemon without slow clients. In the next rows the same slow clients are connected to BARE, a
# program that does only libmicrohttpd's work: the waits in these rows are caused by the clients
# themselves, which take a processor from the daemon. BARE keeps the clients until it ends, which
# closes all of them at once. Each wait is printed as a multiple of that in the first row and, at
# the end, the median with the daemon's slow clients as a multiple of that with BARE's, for the
# three stages of their life.
set -eu
hedged=$1 bare=$2 clients=${3:-1000} side=${4:-200}
for program in slowhttptest wrk curl ss; do
    command -v $program >/dev/null || { echo "slow.sh: $program is not installed" >&2; exit 1; }
done
. "$(dirname "$0")/daemon.sh"
daemon_start "$hedged" --log off
curl -s -o "$work/made" -X PUT -H 'Content-Type: application/json' \
    -d "{\"shape\":\"grid\",\"columns\":$side,\"rows\":$side}" "$base/v1/meshes/m"
port=${base##*:}

mkfifo "$work/stdin" "$work/port"
"$bare" 2 "$(head -c 100000 /dev/zero | tr '\0' x)" <"$work/stdin" >"$work/port" &
others=$!
exec 3>"$work/stdin"
read -r bare_port <"$work/port"

connected() {
    ss -tnH state established "( sport = :$1 )" | wc -l
}

# row WHERE SECONDS PORT: measures a row, and counts the connections at PORT after it in $open. The
# stage of the row follows from how many were open before and after it.
row() {
    before=$open
    wrk -t1 -c8 -d2s --latency "$base/v1/meshes/m/vertices/0" >"$work/wrk"
    open=$(connected "$3")
    memory=$(curl -s "$base/v1/meshes" | sed 's/.*"memory_bytes":\([0-9]*\).*/\1/')
    stage=reading
    [ "$before" -ge "$open" ] || stage=connecting
    [ "$before" -le "$open" ] || stage=closing
    [ "$1" != alone ] || stage=alone
    awk -v where="$1" -v seconds="$2" -v open="$open" -v memory="$memory" -v stage="$stage" \
        -v rows="$work/rows" '
        function ms(text) { return text ~ /us$/ ? text / 1000 : text ~ /ms$/ ? text + 0 : text * 1000 }
        /99%/ { p99 = ms($2) } /Requests\/sec/ { rate = $2 }
        END {
            alone = p99
            while ((getline line < rows) > 0) { split(line, f); if (f[1] == "alone") alone = f[3] }
            printf "%-7s %7s %-10s %6d %8.2f %7.1f %10d %8.1f\n", where, seconds, stage, open, p99,
                p99 / alone, rate, memory / 1048576
            print where, stage, p99 >> rows
        }
    ' "$work/wrk"
}

# slow_clients ADDRESS: connects the slow clients to this server
slow_clients() {
    chrt --idle 0 slowhttptest -X -c "$clients" -r "$clients" -w 512 -y 1024 -n 5 -z 32 -l 20 -p 3 \
        -u "$1" >"$work/slow" 2>&1 3>&- &
    slow=$!
    others="$others $slow"
    began=$(date +%s)
}
since() { echo $(($(date +%s) - began)); }

: >"$work/rows"
open=0
printf '%-7s %7s %-10s %6s %8s %7s %10s %8s\n' clients seconds stage open 'p99 ms' 'x alone' \
    requests/s MiB
row alone - "$port"

open=0
slow_clients "http://127.0.0.1:$bare_port/"
for _ in 1 2 3 4 5; do
    row bare "$(since)" "$bare_port"
done
exec 3>&-
row bare "$(since)" "$bare_port"
kill "$slow" 2>/dev/null || :
wait "$slow" 2>/dev/null || :

open=0
slow_clients "$base/v1/meshes/m/content?format=obj"
row hedged "$(since)" "$port"
until [ "$open" -eq 0 ]; do
    row hedged "$(since)" "$port"
done

# The median and the maximum of each stage. On two processors, which the clients share with the
# daemon, a single row depends on the scheduler as well: the medians can be compared.
sort -k1,1 -k2,2 -k3,3n "$work/rows" | awk '
    { key = $1 " " $2; p99[key, ++count[key]] = $3 }
    function median(key, n) {
        n = count[key]
        return (p99[key, int((n + 1) / 2)] + p99[key, int(n / 2) + 1]) / 2
    }
    END {
        n = split("connecting reading closing", stages)
        for (i = 1; i <= n; i++) {
            ours = "hedged " stages[i]; theirs = "bare " stages[i]
            if (count[ours] > 0 && count[theirs] > 0)
                printf "%-10s median p99 %6.2f ms (at most %.2f) beside the clients of hedged, " \
                    "%6.2f (%.2f) beside those of bare: %.2f x\n", stages[i], median(ours),
                    p99[ours, count[ours]], median(theirs), p99[theirs, count[theirs]],
                    median(ours) / median(theirs)
        }
    }
'
