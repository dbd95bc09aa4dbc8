#!/bin/sh
# transport.sh - runs $TRANSPORTED, the quickest programs of tests/e2e, over TLS and on a Unix
# socket. `make test TESTS=e2e TRANSPORT=tls` runs all of them over TLS.
set -u

passed=0
failed=0
said=$(mktemp)
trap 'rm -f "$said"' EXIT

# sum WORD: adds up the numbers of tests that cmocka reports with this word
sum() {
    sed -n "s/^\[  $1 *\] \([0-9][0-9]*\) test(s).*/\1/p" "$said" | awk '{ n += $1 } END { print n + 0 }'
}

for transport in tls unix; do
    for program in $TRANSPORTED; do
        TRANSPORT=$transport "$program" >"$said" 2>&1
        status=$?
        p=$(sum PASSED)
        f=$(sum FAILED)
        # A program that fails without a report, or that runs no test, counts as one failure.
        [ "$f" -gt 0 ] || { [ "$status" -eq 0 ] && [ "$p" -gt 0 ]; } || f=1
        passed=$((passed + p))
        failed=$((failed + f))
        [ "$f" -eq 0 ] || { echo "over $transport: $program"; cat "$said"; }
        sed -n "s/^note: not over/note: $(basename "$program"): not over/p" "$said"
    done
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
