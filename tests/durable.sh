#!/bin/sh
# durable.sh - runs a few rounds of each proof of `make durable` (tests/durable/run.py), with the
# seed that `make test` is given or draws.
set -u

built=$(dirname "$HEDGED")/tests/durable
passed=0
failed=0
work=$(mktemp -d "$(dirname "$HEDGED")/durable.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# prove NAME ROUNDS [EVERY]
prove() {
    python3 -B tests/durable/run.py --hedged "$HEDGED" --faults "$built/faults.so" \
        --damage "$built/damage_store" --proof "$1" --rounds "$2" ${3:+--every "$3"} \
        --work "$work" ${SEED:+--seed "$SEED"} >"$work/log" 2>&1
    counts=$(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$work/log")
    # shellcheck disable=SC2086 # two numbers
    set -- "$1" ${counts:-0 1}
    passed=$((passed + $2))
    failed=$((failed + $3))
    if [ "$3" -eq 0 ]; then
        sed -n '/^note: /p' "$work/log"
    else
        cat "$work/log"
    fi
}

prove self 1
prove strace 1
prove two 1
prove stop 1
prove kill 10
prove sync 2
prove many 1500
prove backup 1
prove restore 2
prove golden 1
prove cut 1 101
prove flip 1 1009
if unshare --mount true 2>/dev/null; then
    prove full 1
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
