"""faulty.py - each sync and each write of a hundred edits fails in turn (D3, D4, D5).

    kill    the daemon is killed before the N-th sync
    power   as `kill`, and everything that was not synced is lost as well
    sync    the N-th sync fails
    full    the N-th write finds the disk full, once
    short   the N-th write is cut to half, and the next one finds the disk full

The answers are compared with what is there afterwards, both while the daemon goes on and after a
restart without faults. A first run counts the calls; ROUNDS of each kind are tried, spread over the
calls, or all if there are fewer.
"""
import os
import random
import re
import shutil
import threading

from daemon import Gone, Refused
from replay import Replay
from writers import Draw, Log, Writer

EDITS = 100
MESH = 'a'
WAYS = {'kill': ('syncs', 'FAULT_KILL'), 'power': ('syncs', 'FAULT_KILL'),
        'sync': ('syncs', 'FAULT_SYNC'), 'full': ('writes', 'FAULT_WRITE'),
        'short': ('writes', 'FAULT_SHORT')}
KINDS = [('edit', 50), ('list', 10), ('undo', 10), ('redo', 5), ('name', 8), ('put', 4),
         ('attribute', 5), ('values', 5), ('job', 3)]
DISK_CODES = ('store_full', 'store_failed', 'store_lost')


class Attempt:
    """A hundred edits of one client in a store of its own."""

    def __init__(self, run, name, faults):
        self.run, self.name = run, name
        self.folder = run.folder('store')
        self.report, self.platter = run.folder('report'), run.folder('platter')
        self.faults = {**faults, 'FAULT_REPORT': self.report, 'FAULT_PLATTER': self.platter}
        for path in (self.folder, self.platter):
            shutil.rmtree(path, ignore_errors=True)
        os.makedirs(self.platter)
        if os.path.exists(self.report):
            os.remove(self.report)
        self.log, self.answers = Log(), {}

    def go(self, seed):
        """Runs the edits; returns the daemon, if it still runs."""
        try:
            daemon = self.run.start(faults=self.faults)
        except Refused as refused:
            self.run.count('refused to start')
            self.run.judge(f'{self.name}: the refusal says why',
                           refused.status < 0 or len(refused.said) > 40, refused)
            return None
        writer = Patient(daemon.port, self.log, [MESH], Draw(random.Random(seed), 'w'),
                         kinds=KINDS, limit=EDITS)
        writer.start()
        writer.join()
        writer.client.close()
        if self.fired('kill'):
            daemon.wait()
            return None
        return daemon

    def fired(self, what=''):
        if not os.path.exists(self.report):
            return False
        with open(self.report, encoding='ascii') as file:
            return 'fired ' + what in file.read()

    def totals(self):
        with open(self.report, encoding='ascii') as file:
            return {name: int(n) for name, n in re.findall(r'(\w+) (\d+)', file.read())}

    def judge(self, daemon, flying, done):
        replay = Replay(self.run.hedged, [])
        client = daemon.client()
        good = self.run.attempt(f'{self.name}: what was acknowledged is there', self.compare,
                                replay, client, done, flying)
        client.close()
        replay.close()
        return good

    @staticmethod
    def compare(replay, client, done, flying):
        replay.follow(client, MESH, done, flying)
        replay.walk(client, MESH)
        return True


class Patient(Writer):
    """A client that gives up if the disk does not work again."""

    refusals = 0

    def refuse(self, change, answer):
        if answer.code() not in DISK_CODES:
            self.log.strange.append(f'{change!r}: {answer.status} {answer.body[:200]!r}')
        # A change that found no space must not be there. A change whose sync failed may have
        # reached the disk; and what is reported of a job is not proof about its change.
        if answer.code() != 'store_full' or change.job:
            self.log.open.append(change)
        self.refusals += 1
        if answer.code() == 'store_failed' or self.refusals > 300:
            self.ending.set()
        elif answer.code() == 'store_full':
            threading.Event().wait(0.05)  # a second until the disk is tried again


def try_one(run, way, n):
    call, variable = WAYS[way]
    name = f'{way} at {call[:-1]} {n}'
    attempt = Attempt(run, name, {variable: n})
    seed = run.chance.random()
    daemon = attempt.go(seed)
    run.judge(f'{name}: nothing strange', not attempt.log.strange, attempt.log.strange[:2])
    done, flying = attempt.log.take()
    if daemon is not None:
        # After the failure the daemon must answer reads, which show what will be there after a
        # restart, no more and no less.
        client = daemon.client()
        seen = client.get(f'/v1/meshes/{MESH}')
        if way in ('full', 'short') and len(done) < EDITS and attempt.fired():
            run.judge(f'{name}: writes work again', False, f'{len(done)} of {EDITS}')
        run.judge(f'{name}: reads go on', seen.status in (200, 404), seen.body[:200])
        client.close()
        stopped = daemon.stop()
        run.judge(f'{name}: it stops', stopped == 0 or attempt.fired('kill')
                  or way == 'sync', daemon.log())
    if not attempt.fired():
        run.count(f'{way} did not fire')
        return
    run.count(f'{way} fired')
    run.count('changes', len(done))
    if way == 'power':
        shutil.rmtree(attempt.folder)
        shutil.move(attempt.platter, attempt.folder)
    try:
        again = run.start()
    except Refused as refused:
        run.judge(f'{name}: it starts again', False, refused)
        return
    attempt.judge(again, flying, done)
    run.judge(f'{name}: it stops', again.stop() == 0, again.log())


def prove(run):
    first = Attempt(run, 'without a fault', {})
    daemon = first.go(run.chance.random())
    run.judge('without a fault', daemon.stop() == 0 and not first.log.strange, first.log.strange[:2])
    totals = first.totals()
    run.count('syncs', totals['syncs'])
    run.count('writes', totals['writes'])
    for way, (call, _) in WAYS.items():
        many = totals[call]
        # Two runs may differ by a few calls, so the points of failure are taken from those calls
        # that every run makes.
        points = range(1, many + 1) if run.rounds >= many else \
            sorted(run.chance.sample(range(1, many * 9 // 10), run.rounds))
        for n in points:
            try:
                try_one(run, way, n)
            except Gone as gone:
                run.judge(f'{way} {n}', False, f'the daemon is gone: {gone}')
    run.expect_fired(*(f'{way} fired' for way in WAYS))
