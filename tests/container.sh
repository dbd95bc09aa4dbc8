#!/bin/sh
# container.sh - builds the image of the Dockerfile and tries it, with buildah as root.
#
# If the registry cannot be reached, the base image is made with debootstrap. Behind a proxy with a
# certificate of its own, NODE_EXTRA_CA_CERTS is the file that npm must trust while the page is
# built. If the image cannot be tried, the script fails, because nothing was shown.
set -u
cd "$(dirname "$0")/.." || exit 1
. tests/bare.sh

give_up() {
    echo "FAILED nothing was tried: $1"
    echo "0 passed, 1 failed"
    exit 1
}
[ "$(id -u)" -eq 0 ] || give_up 'the container is built and entered as root'
for tool in buildah debootstrap curl; do
    command -v "$tool" >/dev/null || give_up "there is no $tool (apt-get install $tool)"
done

base=docker.io/library/debian:bookworm-slim
image=localhost/hedge-test:$$
work=$(mktemp -d)
container=
daemon=
finish() {
    [ -z "$daemon" ] || kill "$daemon" 2>/dev/null
    if [ -n "$container" ]; then
        buildah umount "$container"
        buildah rm "$container"
    fi
    buildah rmi "$image"
    rm -rf "$work"
}
trap 'finish >/dev/null 2>&1' EXIT
trap 'exit 1' INT TERM

passed=0
failed=0
check() {
    title=$1
    shift
    if "$@" >"$work/said" 2>&1; then
        passed=$((passed + 1))
        echo "ok $title"
        sed -n '/^note: /p' "$work/said"
    else
        failed=$((failed + 1))
        tail -n 40 "$work/said"
        echo "FAILED $title"
    fi
}

end() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
    exit
}

has_base() {
    buildah inspect --type image "$base" || buildah pull "$base" && return
    bare_debian "$work/base" || return 1
    scratch=$(buildah from scratch) && buildah add -q "$scratch" "$work/base" / &&
        buildah commit -q --rm "$scratch" "$base" && rm -rf "$work/base"
}

size_of() {
    buildah images --format '{{.Size}}' "$1"
}

builds() {
    set -- --isolation chroot --format docker --layers --tag "$image"
    if [ -n "${NODE_EXTRA_CA_CERTS:-}" ]; then
        echo 'cafile=/run/ca.crt' >"$work/npmrc"
        set -- "$@" --volume "$NODE_EXTRA_CA_CERTS:/run/ca.crt:ro" \
            --volume "$work/npmrc:/root/.npmrc:ro"
    fi
    buildah bud "$@" --build-arg "REVISION=$(git rev-parse HEAD 2>/dev/null)" . || return 1
    echo "note: the image has $(size_of "$image"), of which the base is $(size_of "$base")"
}

# config TEMPLATE: prints a part of the image's configuration
config() {
    buildah inspect --type image --format "{{$1}}" "$image"
}

says() {
    [ "$1" = "$2" ] || { echo "\"$1\" instead of \"$2\""; return 1; }
}

# label NAME: prints a label org.opencontainers.image.NAME of the image
label() {
    config "index .Docker.Config.Labels \"org.opencontainers.image.$1\""
}

is_described() {
    revision=$(label revision)
    says "$(config .Docker.Config.User)" 10001:10001 &&
        says "$(config .Docker.Config.Entrypoint)" '[hedged]' &&
        says "$(config .Docker.Config.StopSignal)" SIGTERM &&
        says "$(config .Docker.Config.ExposedPorts)" 'map[8080/tcp:{}]' &&
        says "$(config .Docker.Config.Healthcheck.Test)" '[CMD hedged --healthcheck]' &&
        says "$revision" "$(git rev-parse HEAD 2>/dev/null)" &&
        says "hedged $(label version)${revision:+ (commit $revision)}" \
            "$(chroot "$root" /usr/local/bin/hedged --version)" &&
        says "$(label licenses)" MIT
}

has_no_tools() {
    for tool in gcc make node npm curl; do
        ! ls "$root/usr/bin/$tool" || return 1
    done
}

# inside VARIABLES COMMAND...: runs a command in a container of the image, as the image's user
inside() {
    variables=$1
    shift
    # shellcheck disable=SC2086 # a list of options
    buildah run --isolation chroot $variables "$container" -- "$@"
}

# The daemon must listen beyond the loopback interface only if an option says so.
refuses_to_be_open() {
    inside '' sh -c 'hedged 2>/tmp/said'
    says $? 2 && grep 'set --insecure' "$root/tmp/said"
}

# Reads lines of the log until the daemon is ready; sets `base` to its address.
wait_until_ready() {
    base=
    while [ -z "$base" ] && read -r line <&4; do
        echo "$line"
        case $line in
        *'listening on http://0.0.0.0:'*) base=http://127.0.0.1:${line##*:} ;;
        esac
    done
    [ -n "$base" ]
}

# Makes a token with the image's own program, and a file with its line.
makes_a_token() {
    inside '' hedged --new-token alice write >"$work/token" || return 1
    token=$(head -n 1 "$work/token")
    [ "${#token}" -eq 49 ] && tail -n 1 "$work/token" >"$root/tokens" && chmod 644 "$root/tokens"
}

get() {
    curl -sSf -H "Authorization: Bearer $token" "$@"
}

creates_and_edits() {
    curl -sSf "$base/" | grep -q '<title>hedge</title>' || return 1
    says "$(curl -sS -o /dev/null -w '%{http_code}' "$base/v1/meshes")" 401 || return 1
    get -o "$work/answer" -w '%{http_code}\n' -H 'Content-Type: application/json' \
        -d '{"shape":"cube"}' "$base/v1/meshes?id=box" | grep -qx 201 || return 1
    get -H 'Content-Type: application/json' -d '{"op":"edge_split","edge":0}' \
        "$base/v1/meshes/box/edits" | grep -q '"revision":2,' || return 1
    get "$base/v1/meshes/box" | grep -q '"vertices":9,'
}

# Requires that the mesh made by creates_and_edits is still there after the daemon was stopped and
# started, with its undo.
is_still_there() {
    get "$base/v1/meshes/box" | grep -q '"vertices":9,' || return 1
    get -X POST "$base/v1/meshes/box/undo" | grep -q '"revision":3,' || return 1
    get "$base/v1/meshes/box" | grep -q '"vertices":8,'
}

is_healthy() {
    inside "--env HEDGE_LISTEN=0.0.0.0:${base##*:}" hedged --healthcheck
}

is_not_healthy() {
    inside '--env HEDGE_LISTEN=0.0.0.0:1' hedged --healthcheck
    says $? 1
}

# Finds the process that buildah or unshare has started: the last one in the chain of their
# children. buildah's own way to stop a container is harsher than an engine's, so the signal is sent
# to the daemon itself.
find_first() {
    first=$daemon
    while child=$(cat /proc/"$first"/task/*/children | cut -d ' ' -f 1) && [ -n "$child" ]; do
        first=$child
    done
    says "$(cat "/proc/$first/comm")" hedged
}

stops() {
    kill -TERM "$first"
    wait "$daemon"
    status=$?
    daemon=
    says "$status" 0
}

# Starts the container with buildah.
start_in_container() {
    inside '--env HEDGE_TOKENS=/tokens --env HEDGE_LISTEN=0.0.0.0:0' hedged --log off 2>"$work/log" &
    daemon=$!
    exec 4<"$work/log"
    wait_until_ready && find_first
}

# Starts the container as an engine does with --read-only and a volume: the daemon is the first
# process, and its root folder cannot be written to, except for /data.
start_read_only() {
    install -d -o 10001 -g 10001 -m 700 "$work/data" || return 1
    env -i HEDGE_TOKENS=/tokens HEDGE_LISTEN=0.0.0.0:0 HEDGE_STORE=sqlite:/data \
        PATH="$PATH:/usr/local/bin" unshare --mount --pid --fork sh -c '
            mount --bind "$1" "$1" && mount -o remount,bind,ro "$1" && mount -t proc proc "$1/proc" &&
                mount --bind "$2" "$1/data" &&
                exec chroot --userspec=10001:10001 "$1" hedged --log off' - "$root" "$work/data" \
        2>"$work/log" &
    daemon=$!
    exec 4<"$work/log"
    wait_until_ready && find_first
}

is_nobody() {
    says "$(awk '/^[UG]id:/ { print $2, $3, $4, $5 }' "/proc/$first/status" | uniq)" \
        '10001 10001 10001 10001'
}

is_locked_in() {
    is_nobody || return 1
    says "$(awk '/^NSpid:/ { print $NF }' "/proc/$first/status")" 1 || return 1
    says "$(awk '/^CapEff:/ { print $2 }' "/proc/$first/status")" 0000000000000000 || return 1
    touch "/proc/$first/root/tmp/x" 2>&1 | grep 'Read-only file system'
}

# Makes a backup beside the daemon and verifies it. Both times hedged is run as `docker exec` runs it,
# without a shell.
backs_up() {
    for task in --backup --verify; do
        env -i HEDGE_STORE=sqlite:/data PATH="$PATH:/usr/local/bin" nsenter --target "$first" --mount \
            --pid --root --wd --setuid 10001 --setgid 10001 hedged "$task" /data/backup.db || return 1
    done
}

mkfifo "$work/log"
check 'there is the base image' has_base
check 'the image builds' builds
[ "$failed" -eq 0 ] || end
container=$(buildah from "$image") && root=$(buildah mount "$container") || exit 1
check 'it says what it is and how it is run' is_described
check 'it has no compiler and no package manager of the page' has_no_tools
check 'it refuses to be reached when nobody said so' refuses_to_be_open
check 'a closed port is not healthy' is_not_healthy

check 'it makes a token' makes_a_token
check 'it starts' start_in_container
if [ -n "$base" ]; then
    check 'it runs as nobody in particular' is_nobody
    check 'its health check passes' is_healthy
    check 'a mesh is created and edited' creates_and_edits
    check 'SIGTERM stops it with status 0' stops
fi

check 'it starts on a read-only root' start_read_only
if [ -n "$base" ]; then
    check 'it is process 1, without rights, on a root that cannot be written' is_locked_in
    check 'a mesh is created and edited there' creates_and_edits
    check 'a backup is made beside the daemon' backs_up
    check 'SIGTERM stops process 1 with status 0' stops
fi
check 'it starts again with the same volume' start_read_only
if [ -n "$base" ]; then
    check 'the mesh and its undo are still there' is_still_there
    check 'SIGTERM stops it again' stops
fi
end
