#!/bin/sh
# fresh.sh - checks that each command in the README's table works on a machine where nothing was
# done before.
#
# A bare Debian is made with debootstrap; make is all that is added. It stays in build/fresh/bare,
# where it is used for a day. For each command it is copied, the last commit of this tree is put
# inside, and the command runs there alone, as root, with the few rounds below. TARGETS selects
# commands, as in TARGETS="lint bench-http"; TESTS selects what make test runs. Each command leaves
# build/fresh/NAME.log. The copies, of 1 to 4 GB, are made in FRESH_DIR or beside the logs, and
# removed. The last line is `N passed, N failed`.
#
# The copy gets what this machine needs to reach its mirrors: the sources and settings of apt, the
# settings of npm, and the proxies and certificates that the environment names.
set -u

# --- inside, where the copy is the root folder -----------------------------------------------

# Runs `make run` until the daemon is ready, then stops it as a user would.
run_until_ready() {
    mkfifo /tmp/said
    setsid make run RUN_FLAGS='--listen 127.0.0.1:0' >/tmp/said 2>&1 &
    job=$!
    ready=
    while read -r line; do
        echo "$line"
        case $line in
        *'listening on http://'*)
            ready=yes
            kill -TERM "-$job"
            ;;
        esac
    done </tmp/said
    [ -n "$ready" ]
}

if [ "${1-}" = --inside ]; then
    cd /src/hedge || exit 1
    # Commands that run in rounds get few of them.
    case $2 in
    run) run_until_ready ;;
    bench) make bench RUNS=1 SCALE=0.1 ;;
    report) make report REPORTS='bench bench-space' BENCH=onering RUNS=1 SCALE=0.1 ;;
    fuzz) make fuzz FUZZ_SECONDS=1 ;;
    soak) make soak MINUTES=1 ;;
    proof) make proof ROUNDS=1 ;;
    */*) sh "$2" ;;
    *) make "$2" ;;
    esac
    exit
fi

# --- between: in namespaces of its own, so that mounts and processes end with it ---------------

cd "$(dirname "$0")/.." || exit 1
if [ "${1-}" = --enter ]; then
    root=$2
    name=$3
    downloads=$4
    # Programs that change mounts require that the root folder is a mount of its own.
    mount --bind "$root" "$root" && mount -t proc proc "$root/proc" && mount --rbind /sys "$root/sys" &&
        mount --rbind /dev "$root/dev" &&
        mount --bind "$downloads/apt" "$root/var/cache/apt/archives" &&
        mount --bind "$downloads/npm" "$root/root/.npm" || exit 1
    set -- PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
        ${TESTS:+"TESTS=$TESTS"}
    for variable in $(env | sed -n 's/^\(npm_config_[A-Za-z0-9_]*\|[A-Za-z]*_[Pp][Rr][Oo][Xx][Yy]\)=.*/\1/p'); do
        eval "set -- \"\$@\" \"$variable=\$$variable\""
    done
    certificates=/etc/machine-certificates.crt
    [ ! -e "$root$certificates" ] || set -- "$@" "SSL_CERT_FILE=$certificates" \
        "NODE_EXTRA_CA_CERTS=$certificates" "npm_config_cafile=$certificates"
    exec chroot "$root" env -i "$@" sh /src/hedge/tests/fresh.sh --inside "$name"
fi

# --- outside --------------------------------------------------------------------------------

. tests/bare.sh

give_up() {
    echo "FAILED nothing was tried: $1"
    echo "0 passed, 1 failed"
    exit 1
}
[ "$(id -u)" -eq 0 ] || give_up 'a bare Debian is made and entered as root'
command -v debootstrap >/dev/null || give_up 'there is no debootstrap (apt-get install debootstrap)'
command -v git >/dev/null || give_up 'there is no git (apt-get install git)'

# Prints the targets that the first column of the README's table names: fuzz for `make fuzz
# FUZZ_SECONDS=20`, and .ci/run as it is. This script itself is left out.
table() {
    awk -F'|' '/^\| command \|/ { rows = 1; next } rows && !/^\|/ { exit } rows { print $2 }' \
        README.md | grep -o '`[^`]*`' | tr -d '`' |
        awk '$1 == "make" { print ($2 == "" ? "all" : $2); next } { print $1 }' | grep -vx fresh
}

# settings FOLDER: copies what the machine needs to reach its mirrors
settings() {
    bare_sources >"$1/etc/apt/sources.list"
    apt-config dump Acquire >"$1/etc/apt/apt.conf.d/90machine"
    cp /etc/resolv.conf "$1/etc/resolv.conf"
    cafile=
    if command -v npm >/dev/null; then
        for file in "$(npm config get globalconfig)" "$(npm config get userconfig)"; do
            [ ! -e "$file" ] || cat "$file" >>"$1/root/.npmrc"
        done
        cafile=$(npm config get cafile)
    fi
    for file in "${NODE_EXTRA_CA_CERTS:-}" "${SSL_CERT_FILE:-}" "$cafile"; do
        [ ! -f "$file" ] || { cp "$file" "$1/etc/machine-certificates.crt" && break; }
    done
    mkdir -p "$1/root/.npm" "$1/src"
}

targets=${TARGETS:-$(table)}
[ -n "$targets" ] || give_up 'README.md has no table of commands'
mkdir -p build/fresh
logs=$(cd build/fresh && pwd)
downloads=$logs/downloads
mkdir -p "$downloads/apt/partial" "$downloads/npm"
work=$(mktemp -d -p "${FRESH_DIR:-$logs}" tree.XXXXXX) || give_up 'there is no place for copies'
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 1' INT TERM

# The date of bare.made shows that the folder is complete, and how old it is. No command runs in
# this folder.
bare=$logs/bare
if [ -z "$(find "$bare.made" -mtime -1 2>/dev/null)" ]; then
    rm -rf --one-file-system "$bare" "$bare.made"
    { bare_debian "$bare" make && touch "$bare.made"; } >"$bare.log" 2>&1 || {
        tail -n 40 "$bare.log"
        give_up 'a bare Debian could not be made'
    }
fi
passed=0
failed=0
for target in $targets; do
    case $target in
    */*) shown=$target ;;
    *) shown="make $target" ;;
    esac
    log=$logs/$(basename "$target").log
    start=$(date +%s)
    if cp -a --reflink=auto "$bare" "$work/root" && settings "$work/root" &&
        git clone -q --no-hardlinks . "$work/root/src/hedge" &&
        unshare --mount --pid --fork --kill-child sh tests/fresh.sh --enter "$work/root" "$target" \
            "$downloads" >"$log" 2>&1 </dev/null; then
        passed=$((passed + 1))
        echo "ok $shown ($(($(date +%s) - start)) s): $(tail -n 1 "$log" | cut -c 1-100)"
    else
        failed=$((failed + 1))
        tail -n 40 "$log"
        echo "FAILED $shown ($(($(date +%s) - start)) s): $log"
    fi
    rm -rf --one-file-system "$work/root"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
