#!/bin/sh
# Measures how long small requests wait while the daemon does long work for others.
#
#   fair.sh HEDGED PACED [SECONDS [SIDE]]
#
# A calm client requests a vertex of a small mesh 500 times a second over 8 connections. Meanwhile
# another client uploads a file of SIDE x SIDE quads cut into triangles (a million) again and again,
# then downloads one, then decimates the mesh as a dry run, and then checks it for faces that
# intersect. In the first rows the calm client is alone; the best of three counts. Beside long work
# its 99th percentile may be 5 ms longer. A machine that stops for some milliseconds now and then
# does so in any row, so a row beyond that is measured again, three times at most; a daemon that is
# kept from small requests would be late each time. If it is, the exit status is 1.
#
# The client of the long work runs only when nothing else wants to: it stands for another machine.
set -eu
hedged=$1 paced=$2 seconds=${3:-8} side=${4:-724}
command -v curl >/dev/null || { echo "fair.sh: curl is not installed" >&2; exit 1; }
. "$(dirname "$0")/daemon.sh"
daemon_start "$hedged" --log off
port=${base##*:}
meshes=$base/v1/meshes
path=/v1/meshes/small/vertices/0
json='Content-Type: application/json'

# ask STATUS CURL-ARGUMENTS...: sends a request of the long work, which must be answered by STATUS
ask() {
    status=$1
    shift
    got=$(chrt --idle 0 curl -s -H 'Prefer: wait=600' -o "$work/answer" -w '%{http_code}' "$@" 4<&-)
    [ "$got" = "$status" ] || { echo "$got instead of $status for $*" >&2; head -c 400 "$work/answer" >&2; return 1; }
}
edit() {
    ask 200 -H "$json" "$meshes/large/edits" -d "$1"
}
ask 201 -X PUT -H "$json" "$meshes/small" -d '{"shape":"grid","columns":200,"rows":200}'
ask 201 -X PUT -H "$json" "$meshes/large" \
    -d "{\"shape\":\"torus\",\"major_segments\":$side,\"minor_segments\":$side}"
edit '{"op":"triangulate"}'
ask 200 "$meshes/large/content?format=obj"
mv "$work/answer" "$work/large.obj"
ask 201 -X PUT -H 'Content-Type: model/obj' -T "$work/large.obj" "$meshes/copy"

import() { ask 200 -X PUT -H 'Content-Type: model/obj' -T "$work/large.obj" "$meshes/copy"; }
export_file() { ask 200 "$meshes/large/content?format=obj"; }
check() { ask 200 "$meshes/large/check?self_intersections=true"; }
decimate() { edit '{"dry_run":true,"ops":[{"op":"decimate","ratio":0.1}]}'; }

# repeat WORK: does the work again and again until $work/stop exists, and counts how often
repeat() {
    rm -f "$work/stop"
    (
        count=0
        until [ -e "$work/stop" ]; do
            "$1" || exit 1
            count=$((count + 1))
            echo "$count" >"$work/count"
        done
    ) &
    repeating=$!
}

# measure NAME WORK: prints a row; fails if the calm client waited longer than allowed
measure() {
    echo 0 >"$work/count"
    [ "$2" = : ] || repeat "$2"
    "$paced" "$port" $path - 500 8 "$seconds" 0 >"$work/waited" 4<&-
    if [ "$2" != : ]; then
        : >"$work/stop"
        wait "$repeating" || { echo "fair.sh: the long work failed" >&2; exit 1; }
    fi
    awk -v name="$1" -v rows="$work/rows" -v count="$(cat "$work/count")" '{
        quiet = $5
        while ((getline line < rows) > 0) if (line < quiet) quiet = line
        if (count == 0) print $5 >>rows
        verdict = $5 > quiet + 5 ? "MORE THAN ALLOWED" : "ok"
        if ($2 + $3 > 0) verdict = "REFUSED"
        printf "%-24s %6d %6d %8.2f %8.2f %8.2f  %s\n", name, count, $1, $4, $5, quiet + 5, verdict
    }' "$work/waited" >"$work/row"
    cat "$work/row"
    grep -q ' ok$' "$work/row"
}

# row NAME WORK: measures beside the work until the calm client waits no longer than allowed
row() {
    for _ in 1 2 3; do
        if measure "$1" "$2"; then
            return
        fi
    done
    late="${late:-} $2"
}

late=
printf '%-24s %6s %6s %8s %8s %8s\n' beside times answers 'p50 ms' 'p99 ms' allowed
for _ in 1 2 3; do
    measure nobody :
done
row 'imports of OBJ files' import
row 'exports of OBJ files' export_file
row 'decimations' decimate
row 'checks of intersections' check
[ -z "$late" ] || { echo "fair.sh: small requests waited too long beside:$late" >&2; exit 1; }
