"""damaged.py - a small store whose files are cut at every byte, or have every bit flipped (D6, D7).

damage/damage.c does this in one process for each processor, and loads every mesh: everything that
was acknowledged must be there, or its loss must be reported. Each round makes a new store; --every
101 tries only every 101st place, beginning with one drawn from the seed.
"""
import os
import re
import shutil
import subprocess
import tempfile

MEMORY = '/dev/shm'  # in memory, because a million stores are opened


def prove(run, how):
    for _ in range(run.rounds):
        folder = tempfile.mkdtemp(prefix='durable-', dir=MEMORY if os.path.isdir(MEMORY) else run.work)
        try:
            ended = subprocess.run(
                [run.damage, how, folder, str(run.every), str(run.chance.randrange(1 << 32)),
                 str(os.cpu_count())],
                stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        finally:
            shutil.rmtree(folder)
        found = {name: int(n) for n, name in re.findall(r'^(\d+) (.*)$', ended.stdout, re.M)}
        for name in ('places', 'whole', 'named', 'stopped', 'refused'):
            run.count(name, found.get(name, 0))
        run.passed += sum(found.get(name, 0) for name in ('whole', 'named', 'stopped', 'refused'))
        for wrong in re.findall('^WRONG (.*)$', ended.stdout, re.M):
            run.judge(how, False, wrong)
        run.judge('it ended', ended.returncode == 0, f'{ended.returncode} {ended.stderr[-3000:]}')
    run.expect_fired('whole', 'named', 'refused')


def prove_cut(run):
    prove(run, 'cut')


def prove_flip(run):
    prove(run, 'flip')
