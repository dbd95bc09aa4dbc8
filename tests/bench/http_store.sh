#!/bin/sh
# Measures the edits a second through the daemon with meshes in memory and on a disk, in turn: 1, 8
# and 64 writers, on 64 meshes and on one; and lists of 65,536 edge splits, beside the rate at which
# the kernel runs equal lists (lists.c).
#
#   http_store.sh HEDGED FOLDER LISTS [ROUNDS [SECONDS]]      FOLDER on the disk to be measured
set -eu
hedged=$1 folder=$2 lists=$3 rounds=${4:-3} seconds=${5:-2}
. "$(dirname "$0")/daemon.sh"
mkdir -p "$folder"
disk=$(mktemp -d "$folder/http.XXXXXX")
trap 'daemon_stop; rm -rf "$disk"' EXIT INT TERM

cat >"$work/edit.lua" <<'LUA'
wrk.method = "POST"
wrk.headers["Content-Type"] = "application/json"
local n, meshes = 0, tonumber(os.getenv("MESHES"))
function request()
    n = n + 1
    return wrk.format(nil, "/v1/meshes/m" .. n % meshes .. "/edits", nil,
        '{"op":"vertex_move","vertex":' .. n % 42 .. ',"to":[0,0,' .. n .. ']}')
end
LUA

measure() {
    MESHES=$1 wrk -t1 -c"$2" -d"${seconds}s" -s "$work/edit.lua" "$base" |
        awk '/Requests\/sec/ { r = $2 } /Non-2xx/ { bad = 1 } END { if (bad || !r) exit 1; print r }'
}

for round in $(seq "$rounds"); do
    for kind in memory sqlite; do
        store=$kind
        [ "$kind" = memory ] || store=sqlite:$disk/$round
        daemon_start "$hedged" --log off
        for mesh in $(seq 0 63); do
            curl -sf -o /dev/null -X PUT -H 'Content-Type: application/json' \
                "$base/v1/meshes/m$mesh" -d '{"shape":"icosphere","subdivisions":1}'
        done
        for meshes in 64 1; do
            for writers in 1 8 64; do
                measure "$meshes" "$writers" >>"$work/$kind-$meshes-$writers"
            done
        done
        "$lists" "${base##*:}" "$daemon" |
            while read -r name rate spent; do
                echo "$rate" >>"$work/$kind-list-$name"
                echo "$spent" >>"$work/$kind-time-$name"
            done
        kill "$daemon" "$drain"
        wait "$daemon" 2>/dev/null || :
        rm "$work/log"
    done
done

median() { sort -n "$work/$1" | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }
echo "edits a second, medians of $rounds runs of $seconds s"
for meshes in 64 1; do
    for writers in 1 8 64; do
        awk -v meshes="$meshes" -v writers="$writers" -v memory="$(median "memory-$meshes-$writers")" \
            -v disk="$(median "sqlite-$meshes-$writers")" 'BEGIN {
                printf "%2d writers, %2d meshes   memory %8.0f   SQLite %8.0f   %.2f of memory\n",
                    writers, meshes, memory, disk, disk / memory }'
    done
done
echo "edge splits a second in lists of 65,536, with return=minimal, beside the kernel"
for kind in memory sqlite; do
    for name in octets json; do
        awk -v kind="$kind" -v name="$name" -v rate="$(median "$kind-list-$name")" \
            -v time="$(median "$kind-time-$name")" -v kernel="$(median "$kind-list-kernel")" \
            -v kernel_time="$(median "$kind-time-kernel")" 'BEGIN {
                share = rate / kernel
                spent = time / kernel_time
                aim = kind == "memory" && name == "octets"
                printf "%-6s %-6s %8.0f   kernel %8.0f   %.2f of it by rate, %.2f by time%s\n",
                    kind, name, rate, kernel, share, spent,
                    !aim ? "" : "   target 0.60 and 1000000   " \
                        (share >= 0.6 && rate >= 1e6 ? "met" : "falls short") }'
    done
done
