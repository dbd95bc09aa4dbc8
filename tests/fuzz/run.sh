#!/bin/sh
# run.sh SECONDS [TARGET...] - runs libFuzzer on each target for this many seconds, FUZZ_JOBS (2) at
# a time.
#
# The targets were built by `make fuzz`; without names all of them are run. Each begins from
# tests/fuzz/seeds/TARGET, from inputs that earlier runs kept (build/fuzz/corpus/TARGET, which
# grows), and from the files of its kind in FUZZ_FILES (../shared/corpus/files), if that exists.
# FUZZ_SEED repeats a run; without it each run is another. build/fuzz/logs/TARGET.log has
# libFuzzer's output. An input that fails is left in build/fuzz/found; made small by
# -minimize_crash=1 and put into tests/fuzz/found/TARGET, it is a regression test. The last line is
# `N passed, N failed`, counting targets.
set -u

programs=build/fuzz/tests/fuzz
files=${FUZZ_FILES:-../shared/corpus/files}

# With --one the script runs a single target; the other call of this script below uses that.
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
    # guard.c limits the memory and the seconds of a single input; the limits here catch everything
    # else.
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
