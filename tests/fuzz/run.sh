#!/bin/sh
# run.sh SECONDS [TARGET...] - libFuzzer on each target for so many seconds, FUZZ_JOBS (2) at a time.
#
# The targets were built by `make fuzz`; without names all of them run. Each begins from
# tests/fuzz/seeds/TARGET, from what it found worth keeping before (build/fuzz/corpus/TARGET, which
# grows), and from the files of its kind in FUZZ_FILES (../shared/corpus/files), where that exists.
# FUZZ_SEED repeats a run; without it each is another.
# build/fuzz/logs/TARGET.log is libFuzzer's own account. An input that goes wrong is left in
# build/fuzz/found; it is a regression test once it lies, made small by -minimize_crash=1, in
# tests/fuzz/found/TARGET. The last line is `N passed, N failed`, a target each.
set -u

programs=build/fuzz/tests/fuzz
files=${FUZZ_FILES:-../shared/corpus/files}

# Second role: one target.
if [ "${1-}" = --one ]; then
    seconds=$2
    target=$3
    corpus=build/fuzz/corpus/$target
    log=build/fuzz/logs/$target.log
    mkdir -p "$corpus" build/fuzz/logs build/fuzz/found build/fuzz/files/"$target"
    for file in "$files"/*."$target"; do
        [ ! -f "$file" ] || cp -f "$file" build/fuzz/files/"$target"/
    done
    set -- "$corpus" "tests/fuzz/seeds/$target" build/fuzz/files/"$target"
    dictionary=tests/fuzz/seeds/$target.dict
    [ ! -f "$dictionary" ] || set -- -dict="$dictionary" "$@"
    # guard.c counts the memory and the seconds that an input itself takes; these catch the rest.
    ASAN_OPTIONS="${ASAN_OPTIONS:-quarantine_size_mb=16:detect_leaks=1}" \
        "$programs/fuzz_$target" -max_total_time="$seconds" -seed="${FUZZ_SEED:-0}" -max_len=4096 -timeout=20 \
        -rss_limit_mb=1024 -print_final_stats=1 -artifact_prefix="build/fuzz/found/$target-" \
        "$@" >"$log" 2>&1
    status=$?
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
    if [ "$status" -eq 0 ]; then
        echo "ok $target: ${runs:-?} runs in $seconds s, ${edges:-?} edges"
    else
        echo "FAILED $target: $log"
        grep -aE '^fuzz: |runtime error|^\[   LINE|SUMMARY|Test unit' "$log"
    fi
    exit 0
fi

seconds=$1
shift
if [ $# -eq 0 ]; then
    # shellcheck disable=SC2046 # names without blanks
    set -- $(for source in tests/fuzz/fuzz_*.c; do basename "$source" .c | sed 's/^fuzz_//'; done)
fi
said=build/fuzz/said
mkdir -p build/fuzz
printf '%s\n' "$@" | xargs -P "${FUZZ_JOBS:-2}" -I '{}' sh "$0" --one "$seconds" '{}' | tee "$said"
passed=$(grep -c '^ok ' "$said")
failed=$(($# - passed))
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
