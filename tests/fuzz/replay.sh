#!/bin/sh
# FUZZ=FOLDER replay.sh - each target in FOLDER goes through its inputs in tests/fuzz/seeds and
# tests/fuzz/found. The last line is `N passed, N failed`, an input each.
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
        # the last one that it named
        failed=$((failed + 1))
        passed=$((passed + $(grep -c '^tests/fuzz/' "$FUZZ/$target.said") - 1))
        echo "FAILED $program"
        cat "$FUZZ/$target.said"
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
