#!/bin/sh
# hostile.sh - a few rows of what `make hostile` tries whole (tests/hostile/run.py).
exec python3 -B tests/hostile/run.py --hedged "$HEDGED" --quick
