#!/bin/sh
# install.sh - runs `make install` into a folder of its own, and checks that everything is there and
# fits together.
set -u
cd "$(dirname "$0")/.." || exit 1
unset MAKEFLAGS MAKELEVEL MAKEOVERRIDES
work=$(mktemp -d)
daemon=
trap '[ -z "$daemon" ] || kill "$daemon" 2>/dev/null; rm -rf "$work"' EXIT
trap 'exit 1' INT TERM

passed=0
failed=0
check() {
    title=$1
    shift
    if "$@" >"$work/said" 2>&1; then
        passed=$((passed + 1))
        echo "ok $title"
    else
        failed=$((failed + 1))
        cat "$work/said"
        echo "FAILED $title"
    fi
}

root=$work/root
hedged=$root/usr/bin/hedged
man=$root/usr/share/man/man8/hedged.8
unit=$root/usr/lib/systemd/system/hedged.service

# modes FILE...: prints the permissions of files
modes() {
    (cd "$root/usr" && stat -c '%a %n' "$@")
}

installs() {
    make install DESTDIR="$root" PREFIX=/usr || return 1
    modes bin/hedged share/man/man8/hedged.8 lib/systemd/system/hedged.service \
        share/hedge/web/index.html share/hedge/web/docs.html share/hedge/web/docs/start.html \
        share/doc/hedge/LICENSE \
        share/hedge/alerts.yaml >"$work/modes" || return 1
    printf '%s\n' '755 bin/hedged' '644 share/man/man8/hedged.8' \
        '644 lib/systemd/system/hedged.service' '644 share/hedge/web/index.html' \
        '644 share/hedge/web/docs.html' '644 share/hedge/web/docs/start.html' \
        '644 share/doc/hedge/LICENSE' '644 share/hedge/alerts.yaml' |
        diff - "$work/modes"
}

# The installed program must find the page from where it lies, and stop when it is told to.
runs_from_there() {
    mkfifo "$work/log" || return 1
    "$hedged" --listen 127.0.0.1:0 --store memory --log off 2>"$work/log" &
    daemon=$!
    line=$(sed -n '/listening on /{p;q}' "$work/log")
    base=${line##*listening on }
    python3 - "$base" "$root/usr/share/hedge/web/index.html" <<'PY' || return 1
import sys, urllib.request
served = urllib.request.urlopen(sys.argv[1] + "/").read()
sys.exit(served != open(sys.argv[2], "rb").read())
PY
    kill -TERM "$daemon"
    wait "$daemon"
    status=$?
    daemon=
    return $status
}

# Each option, text and variable of --help must be in the manual page, and no placeholder may be left
# in it.
man_is_whole() {
    "$hedged" --help | grep -oE '^  --[a-z-]+|HEDGE_[A-Z_]+' | tr -d ' ' >"$work/names"
    [ "$(wc -l <"$work/names")" -gt 30 ] || return 1
    tr -d '\\' <"$man" >"$work/plain"
    while read -r name; do
        grep -qE -- "^(\.BI \")?$name(\"| |$)" "$work/plain" || { echo "no $name"; return 1; }
    done <"$work/names"
    # Texts begin in column 30. An option that is longer stands alone in its line, and what it has in
    # that column has no blank.
    "$hedged" --help | sed -n '/^  --/,$p' | cut -c 30- | grep -v '^HEDGE_' | grep ' ' >"$work/texts"
    [ "$(wc -l <"$work/texts")" -gt 30 ] || return 1
    while read -r text; do
        grep -qxF -- "$text" "$work/plain" || { echo "no \"$text\""; return 1; }
    done <"$work/texts"
    grep -q "$("$hedged" --version)" "$work/plain" && ! grep -n '@[A-Z]*@' "$man"
}

# The manual page must name each problem (api/json/problem.h) that only a store on the disk causes.
man_has_problems_of_store() {
    sed -n 's/.*X([A-Z_]*, "\(store_[a-z]*\|mesh_damaged\|mesh_newer\|loading\|interrupted\)".*/\1/p' \
        api/json/problem.h >"$work/problems"
    [ "$(wc -l <"$work/problems")" -ge 8 ] || return 1
    while read -r problem; do
        grep -qE "^\.IR? $problem( |$)" "$man" || { echo "no $problem"; return 1; }
    done <"$work/problems"
}

man_is_clean() {
    groff -man -Tascii -ww "$man" 2>"$work/warnings" >/dev/null || return 1
    cat "$work/warnings"
    [ ! -s "$work/warnings" ]
}

unit_is_whole() {
    grep -qx 'ExecStart=/usr/bin/hedged' "$unit" && grep -qx 'StateDirectory=hedge' "$unit" && ! grep -n '@[A-Z]*@' "$unit"
}

# systemd grades what a service is permitted to do from 0 (nothing) to 100: the unit must have a low
# grade.
unit_is_hard() {
    systemd-analyze security --offline=yes --root="$root" --threshold=15 --no-pager \
        hedged.service
}

# Uninstalling must leave files of others in the same folders.
uninstalls() {
    touch "$root/usr/bin/other" && make uninstall DESTDIR="$root" PREFIX=/usr || return 1
    left=$(cd "$root" && find . -type f)
    echo "$left"
    [ "$left" = ./usr/bin/other ]
}

# --version must name the commit of the sources, if git knows it.
version_is_named() {
    commit=$(git describe --always --exclude '*' --abbrev=12 --dirty=+ 2>/dev/null)
    said=$("$hedged" -V) && [ "$said" = "$("$hedged" --version)" ] || return 1
    echo "$said"
    case $said in
    "hedged "[0-9]*.[0-9]*.[0-9]*"${commit:+ (commit $commit)}") ;;
    *) return 1 ;;
    esac
}

check 'make install puts everything in its place' installs
check 'the program runs from there with its page' runs_from_there
check 'the manual page has every option and its text' man_is_whole
check 'the manual page names the problems of a store' man_has_problems_of_store
check 'the unit starts what was installed' unit_is_whole
if command -v groff >/dev/null; then
    check 'the manual page is set without a warning' man_is_clean
else
    echo 'note: no groff: the manual page was not set'
fi
if command -v systemd-analyze >/dev/null; then
    check 'the unit may do little' unit_is_hard
else
    echo 'note: no systemd-analyze: the unit was not graded'
fi

check 'the version names its commit' version_is_named
check 'make uninstall takes all of it away, and nothing else' uninstalls

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
