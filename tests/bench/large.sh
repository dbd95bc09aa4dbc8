#!/bin/sh
# Measures the daemon with a mesh of a million quads: upload, questions, edits and their undo,
# export; in seconds as a client sees them, with the daemon's memory.
#
#   large.sh HEDGED [SIDE]      SIDE x SIDE quads (1024)
set -eu
hedged=$1 side=${2:-1024}
. "$(dirname "$0")/daemon.sh"
daemon_start "$hedged"
meshes=$base/v1/meshes

memory() { awk '/VmRSS/ { r = $2 } /VmHWM/ { h = $2 }
    END { printf "%.0f MB, at most %.0f MB", r / 1000, h / 1000 }' "/proc/$daemon/status"; }
# step NAME STATUS CURL-ARGUMENTS...: sends a request, which must be answered by STATUS, and prints
# its time
step() {
    name=$1 status=$2
    shift 2
    result=$(curl -s -H "Prefer: wait=600" -o "$work/answer" -w '%{http_code} %{time_total}' "$@")
    [ "${result% *}" = "$status" ] || { echo "$name: $result" >&2; head -c 400 "$work/answer" >&2; exit 1; }
    printf '%-34s %8.1f ms   memory %s\n' "$name" \
        "$(echo "${result#* }" | awk '{ print $1 * 1000 }')" "$(memory)"
}
json='Content-Type: application/json'
step "create as a shape" 201 -X PUT -H "$json" "$meshes/shape" \
    -d "{\"shape\":\"torus\",\"major_segments\":$side,\"minor_segments\":$side}"
step "export OBJ" 200 "$meshes/shape/content?format=obj"
mv "$work/answer" "$work/torus.obj"
step "delete" 204 -X DELETE "$meshes/shape"
step "upload OBJ, $(($(wc -c <"$work/torus.obj") / 1000000)) MB" 201 -X PUT -H 'Content-Type: model/obj' \
    -T "$work/torus.obj" "$meshes/m"
step "faces about a vertex" 200 "$meshes/m/vertices/5000/faces"
step "the same again" 200 "$meshes/m/vertices/5000/faces"
step "split an edge" 200 -H "$json" "$meshes/m/edits" -d '{"op":"edge_split","edge":300}'
step "undo" 200 -X POST "$meshes/m/undo"
step "split another edge" 200 -H "$json" "$meshes/m/edits" -d '{"op":"edge_split","edge":777}'
step "undo" 200 -X POST "$meshes/m/undo"
# Each edge split of the batch splits an edge that the one before made.
batch() {
    awk -v head="${1-}" 'BEGIN { printf "{%s\"ops\":[{\"op\":\"edge_split\",\"edge\":0,\"as\":\"s0\"}", head
        for (i = 1; i < 10000; i++)
            printf ",{\"op\":\"edge_split\",\"edge\":\"$s%d.edges.0\",\"as\":\"s%d\"}", i - 1, i
        print "]}" }' >"$work/batch"
}
batch '"dry_run":true,'
step "10,000 edits in one request, dry" 200 -H "$json" "$meshes/m/edits" -d "@$work/batch"
batch
step "the same, made" 200 -H "$json" "$meshes/m/edits" -H 'Idempotency-Key: one' -d "@$work/batch"
step "the same, asked for again" 200 -H "$json" "$meshes/m/edits" -H 'Idempotency-Key: one' \
    -d "@$work/batch"
step "undo" 200 -X POST "$meshes/m/undo"
# The time of an undo depends on its edit and not on the size of the mesh: undoing a thousand edits
# takes as long on a small mesh. So does reading an earlier state, once the first read has made the
# copy.
step "create a small mesh" 201 -X PUT -H "$json" "$meshes/small" \
    -d '{"shape":"torus","major_segments":32,"minor_segments":32}'
for mesh in small m; do
    for edge in $(seq 0 2 1998); do
        [ "$edge" = 0 ] || echo next
        printf 'silent\noutput = /dev/null\nfail\nurl = "%s"\nheader = "%s"\ndata = "%s"\n' \
            "$meshes/$mesh/edits" "$json" "{\\\"op\\\":\\\"edge_split\\\",\\\"edge\\\":$edge}"
    done >"$work/edits"
    curl -K "$work/edits"
    step "undo 1000 edits, mesh $mesh" 200 -H "$json" "$meshes/$mesh/undo" -d '{"steps":1000}'
    step "do them again, mesh $mesh" 200 -H "$json" "$meshes/$mesh/redo" -d '{"steps":1000}'
    step "a vertex 500 revisions ago, $mesh" 200 "$meshes/$mesh/vertices/9?revision=1500"
    step "the same 501 revisions ago, $mesh" 200 "$meshes/$mesh/vertices/9?revision=1499"
    step "back to the first, mesh $mesh" 200 -H "$json" "$meshes/$mesh/undo" -d '{"to_revision":1}'
done
step "summary, computed" 200 "$meshes/m"
step "summary, kept" 200 "$meshes/m"
step "all neighbours as octets" 200 -H "$json" -H 'Accept: application/octet-stream' \
    -H 'Prefer: wait=60' "$meshes/m/query" -d '{"queries":[{"relation":"vertices","of":{"vertices":"all"}}]}'
# word OFFSET: prints a number of eight bytes in the last answer
word() { od -An -tu8 -j "$1" -N 8 "$work/answer" | tr -d ' '; }
step "arrays to draw, first" 200 "$meshes/m/geometry"
step "arrays to draw, again" 200 "$meshes/m/geometry"
query="since=$(word 8)&layout=$(word 80)"
step "split an edge" 200 -H "$json" "$meshes/m/edits" -d '{"op":"edge_split","edge":4242}'
step "what that changed in the arrays" 200 "$meshes/m/geometry?$query"
printf '%-34s %8d bytes\n' "" "$(wc -c <"$work/answer")"
step "undo" 200 -X POST "$meshes/m/undo"
step "what both changed" 200 "$meshes/m/geometry?$query"
printf '%-34s %8d bytes\n' "" "$(wc -c <"$work/answer")"
step "check" 200 "$meshes/m/check"
step "export JSON" 200 "$meshes/m/content"
# The upload as a job: how many values of progress a listener gets, and how long it takes from the
# request to cancel until the memory is free.
start() { curl -s -o /dev/null -w '%header{location}' -X PUT -H "$json" -H 'Prefer: respond-async' \
    "$meshes/$1" -d "{\"shape\":\"torus\",\"major_segments\":$2,\"minor_segments\":$2}"; }
job=$(start j "$side")
values=$(curl -s -N "$base$job/events" | grep -o '"progress":[0-9.]*' | sort -u | wc -l)
printf '%-34s %8d values of progress\n' "create as a job" "$values"
job=$(start k $((side * 4)))
until curl -s "$base$job" | grep -q '"state":"running"'; do :; done
step "cancel a larger one" 202 -X DELETE "$base$job"
# The listener keeps its connection, so this measures only the time until the job has ended.
curl -s -N -o /dev/null -w "until it has ended                 %{time_total} s\n" "$base$job/events"
