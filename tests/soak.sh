#!/bin/sh
# soak.sh - runs a few rounds of what `make soak` does for an hour (tests/soak/soak.mjs).
exec node tests/soak/soak.mjs --rounds 12 --faces 20000 --out build/logs
