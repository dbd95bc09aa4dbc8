#!/bin/sh
# hostile.sh - runs a few rows of `make hostile` (tests/hostile/run.py).
exec python3 -B tests/hostile/run.py --hedged "$HEDGED" --quick
