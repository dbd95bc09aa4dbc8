"""run.py - proves what core/journal promises about restarts, by breaking what can break.

    python3 tests/durable/run.py --hedged build/hedged --faults FAULTS.so --proof NAME
        [--damage PROGRAM] [--rounds N] [--every N] [--seed N] [--work FOLDER]

Each proof prints its rounds, its seed and its counts; the last line is `N passed, N failed`. A
proof in which no fault occurred has proved nothing, and fails. PROOFS below lists all proofs.
"""
import argparse
import faulthandler
import os
import random
import shutil
import signal
import sys
import tempfile
import time
import traceback

import backups
import damaged
import faulty
import full
import golden
import kill
import locks
import many
import self_test
import slow
import stops
import traces
from daemon import Daemon
from replay import Wrong

# Each proof by its name: its function, and the number of rounds if --rounds is not given.
PROOFS = {
    'self': (self_test.prove, 3),
    'kill': (kill.prove, 20),
    'sync': (faulty.prove, 10),
    'strace': (traces.prove, 3),
    'slow': (slow.prove, 1),
    'stop': (stops.prove, 1),
    'full': (full.prove, 2),
    'backup': (backups.prove_backup, 3),
    'restore': (backups.prove_restore, 1000),
    'two': (locks.prove, 3),
    'golden': (golden.prove, 1),
    'cut': (damaged.prove_cut, 1),
    'flip': (damaged.prove_flip, 1),
    'many': (many.prove, 100000),
}


class Run:
    """One proof: its options, its folder, and the tally."""

    def __init__(self, options, rounds):
        self.hedged, self.library, self.damage = options.hedged, options.faults, options.damage
        self.every = options.every
        self.rounds, self.seed = rounds, options.seed
        self.chance = random.Random(options.seed)
        self.passed = self.failed = 0
        self.counts = {}
        self.begun = time.monotonic()
        if options.work:
            os.makedirs(options.work, exist_ok=True)
        self.work = os.path.realpath(tempfile.mkdtemp(prefix=options.proof + '-', dir=options.work))

    def folder(self, name='store'):
        return os.path.join(self.work, name)

    def start(self, flags=(), folder=None, **options):
        if 'faults' in options:
            options['library'] = self.library
            options['faults'].setdefault('FAULT_FOLDER', folder or self.folder())
        return Daemon(self.hedged, ['--store', 'sqlite:' + (folder or self.folder()), *flags],
                      **options)

    def count(self, name, add=1):
        self.counts[name] = self.counts.get(name, 0) + add

    def judge(self, name, good, why=''):
        self.passed += bool(good)
        self.failed += not good
        if not good:
            print(f'FAILED {name}: {why}', flush=True)
        return good

    def attempt(self, name, function, *arguments):
        """Calls a function that may raise Wrong, and judges that; returns its result, or None."""
        try:
            result = function(*arguments)
        except Wrong as wrong:
            self.judge(name, False, wrong)
            return None
        self.judge(name, True)
        return result

    def expect_fired(self, *names):
        """Requires that every fault that the proof is about has occurred."""
        for name in names:
            self.judge(f'{name} fired', self.counts.get(name, 0) > 0, 'a proof without its fault')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--hedged', required=True)
    parser.add_argument('--faults', required=True)
    parser.add_argument('--damage', help='the program of cut and flip')
    parser.add_argument('--proof', required=True, choices=PROOFS)
    parser.add_argument('--rounds', type=int)
    parser.add_argument('--every', type=int, default=1, help='of cut and flip: not every place')
    parser.add_argument('--seed', type=int, default=None)
    parser.add_argument('--work', help='where stores are made: a disk, not memory')
    parser.add_argument('--keep', action='store_true', help='leave the stores there')
    options = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    faulthandler.register(signal.SIGUSR1)
    if options.seed is None:
        options.seed = random.SystemRandom().randrange(1 << 32)
    prove, rounds = PROOFS[options.proof]
    run = Run(options, options.rounds or rounds)
    print(f'PROOF={options.proof} ROUNDS={run.rounds} SEED={run.seed}', flush=True)
    try:
        prove(run)
    except Exception:  # pylint: disable=broad-except
        traceback.print_exc(file=sys.stdout)
        run.judge('the proof', False, 'it ended early')
    finally:
        if options.keep or run.failed:
            print(f'stores are in {run.work}')
        else:
            shutil.rmtree(run.work)
    counts = ', '.join(f'{count} {name}' for name, count in run.counts.items())
    print(f'note: {options.proof}: SEED={run.seed}, {counts or "nothing counted"}, '
          f'{time.monotonic() - run.begun:.0f} s')
    print(f'{run.passed} passed, {run.failed} failed')
    return 1 if run.failed or not run.passed else 0


if __name__ == '__main__':
    sys.exit(main())
