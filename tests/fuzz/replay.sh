#!/bin/sh
# FUZZ=FOLDER replay.sh - runs each target in FOLDER on its inputs in tests/fuzz/seeds and
# tests/fuzz/found. The last line is `N passed, N failed`, counting inputs.
set -u

passed=0
failed=0
for source in tests/fuzz/fuzz_*.c; do
    program=$(basename "$source" .c)
    target=${program#fuzz_}
    # shellcheck disable=SC2046 # names without blanks
    set -- $(find "tests/fuzz/seeds/$target" "tests/fuzz/found/$target" -type f 2>/dev/null | sort)
    if "$FUZZ/$program" "$@" >"$FUZZ/$target.said" 2>&1; then
        passed=$((passed + $#))
    else
        # the input that was named last has failed
        failed=$((failed + 1))
        passed=$((passed + $(grep -c '^tests/fuzz/' "$FUZZ/$target.said") - 1))
        echo "FAILED $program"
        cat "$FUZZ/$target.said"
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
