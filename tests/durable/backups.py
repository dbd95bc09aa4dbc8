"""backups.py - a backup is the state of one moment, and a restore is done completely or not at all
(D9, D10).

The backup is taken while clients write. The restored store must be the replay of all changes up to
some moment between the beginning and the end of the backup, the same moment for all meshes. A
restore is killed before each of its calls that change something, beside a write-ahead log that kill
-9 left. The next start must have all of the old store or all of the new one, or refuse and say what
to do; restored once more, it must have the new one.
"""
import os
import random
import re
import shutil
import subprocess
import threading
import time

from daemon import ETAG, Daemon, Refused, environment
from replay import Replay, Wrong, state
from writers import Draw, write_for

MESHES = ['a', 'b', 'c']
KINDS = [(kind, weight) for kind, weight in Draw.KINDS if kind != 'delete']


def maintain(run, folder, *arguments, faults=None):
    """Runs hedged for one task; returns its exit status and its output."""
    if faults is not None:
        faults = {**faults, 'FAULT_FOLDER': folder}
    ended = subprocess.run([run.hedged, '--store', 'sqlite:' + folder, *arguments],
                           stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                           env=environment(faults, run.library))
    return ended.returncode, ended.stderr + ended.stdout


def write_and_back_up(run, file, folder):
    """Returns the changes that were answered, those in flight, and when the backup began and ended;
    the daemon was killed while clients wrote."""
    daemon = run.start(folder=folder)
    log, writers = write_for(daemon.port, MESHES, random.Random(run.chance.random()),
                             f'b{run.chance.random()}', kinds=KINDS)
    threading.Event().wait(run.chance.uniform(0.1, 0.4))
    begun = time.monotonic()
    status, said = maintain(run, folder, '--backup', file)
    ended = time.monotonic()
    run.judge('a backup is made', status == 0, said)
    threading.Event().wait(0.1)
    daemon.kill()
    for writer in writers:
        writer.stop()
    done, flying = log.take()
    run.judge('nothing strange', not log.strange, log.strange[:2])
    return done, flying, begun, ended


def compare(run, client, done, flying, begun, ended):
    """Requires that the store behind `client` is the replay of a moment between these two. A
    revision that no answer told of must be from a change in flight."""
    replay = Replay(run.hedged, [])
    inside, outside = [], []
    try:
        for mesh in MESHES:
            ours = sorted((c for c in done if c.mesh == mesh),
                          key=lambda c: (c.version[2], c.version[1]))
            found = client.get(f'/v1/meshes/{mesh}').version()
            there = [c for c in ours
                     if found and c.version[1] <= found[1] and c.version[2] <= found[2]]
            inside += there
            outside += [c for c in ours if c not in there]
            if found and found[0] in {c.version[0] for c in ours}:
                raise Wrong(f'{mesh}: its incarnation was used before the restore')
            replay.make_from(mesh, there, [c for c in flying if c.mesh == mesh and c.sent < ended],
                             found, state(client, mesh))
    finally:
        replay.close()
    newest = max((c.sent for c in inside), default=begun)
    lacking = min((c.answered for c in outside), default=ended)
    if lacking < begun or newest > ended or lacking < newest:
        raise Wrong(f'no one moment: the newest change was sent at {newest}, one that is missing was '
                    f'answered at {lacking}, the backup took from {begun} to {ended}')
    run.count('changes before the backup', len(inside))
    run.count('changes after it', len(outside))
    return True


def prove_backup(run):
    for number in range(run.rounds):
        folder, file = run.folder(f'store-{number}'), run.folder(f'backup-{number}.db')
        done, flying, begun, ended = write_and_back_up(run, file, folder)
        other = run.folder(f'restored-{number}')
        status, said = maintain(run, other, '--restore', file)
        run.judge('a restore', status == 0, said)
        daemon = run.start(folder=other)
        client = daemon.client()
        run.attempt('the backup is one moment', compare, run, client, done, flying, begun, ended)
        client.close()
        run.judge('it stops', daemon.stop() == 0, daemon.log())
    run.expect_fired('changes before the backup', 'changes after it')


def views(run, folder):
    """Returns what a daemon shows of a store, and the incarnations separately."""
    daemon = Daemon(run.hedged, ['--store', 'sqlite:' + folder])
    client = daemon.client()
    seen = [state(client, mesh) for mesh in MESHES]
    found = [ETAG.match(client.get(f'/v1/meshes/{mesh}').headers['ETag'])[1] for mesh in MESHES]
    client.close()
    if daemon.stop() != 0:
        raise Wrong(daemon.log())
    return seen, found


def counted_calls(run, folder, file):
    """Returns how many calls of a restore change something."""
    report = run.folder('report')
    maintain(run, folder, '--restore', file, faults={'FAULT_REPORT': report})
    with open(report, encoding='ascii') as told:
        return int(re.search(r'calls (\d+)', told.read())[1])


def kill_restore(run, number, folder, file, old, new):
    """`old` and `new` are what `views` returns for the store before, and after a restore without a
    fault."""
    report, name = run.folder(f'report-{number}'), f'killed before call {number}'
    maintain(run, folder, '--restore', file,
             faults={'FAULT_CALL': number, 'FAULT_REPORT': report})
    with open(report, encoding='ascii') as told:
        run.count('kills', 'fired' in told.read())
    try:
        seen, tags = views(run, folder)
        run.count('old stores', seen == old[0])
        run.count('new stores', seen == new[0])
        run.judge(f'{name}: the old store or the new one',
                  (seen == old[0] and tags == old[1]) or
                  (seen == new[0] and not set(tags) & set(old[1])), [s and s['tag'] for s in seen])
    except Refused as refused:
        run.count('refused to start')
        run.judge(f'{name}: the refusal says what to do', 'restor' in refused.said, refused)
    status, said = maintain(run, folder, '--restore', file)
    run.judge(f'{name}: restored again', status == 0, said)
    run.judge(f'{name}: it is the new store', views(run, folder)[0] == new[0])


def prove_restore(run):
    left, file, folder = run.folder('left'), run.folder('backup.db'), run.folder()
    write_and_back_up(run, file, left)
    run.judge('a -wal was left', os.path.getsize(os.path.join(left, 'hedge.db-wal')) > 0)

    def renew():
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(left, folder)

    renew()
    old = views(run, folder)
    renew()
    calls = counted_calls(run, folder, file)
    new = views(run, folder)
    run.judge('the backup is older', new[0] != old[0])
    # The last calls of a restore matter most, because they move files, so these are always tried.
    numbers = range(1, calls + 1) if run.rounds >= calls else \
        sorted({*run.chance.sample(range(1, calls + 1), run.rounds), *range(calls - 20, calls + 1)})
    run.count('calls', calls)
    for number in numbers:
        renew()
        kill_restore(run, number, folder, file, old, new)
    run.expect_fired('kills', 'old stores', 'new stores')
