"""self_test.py - checks that the proofs would notice a wrong store.

Clients change meshes of a daemon that is never killed: its meshes must be those of the replay. Then
the replay is given fewer changes than were acknowledged, or other ones, and must object each time.
"""
import random
import threading

from daemon import Daemon
from replay import Replay, Wrong
from writers import write_for

MESHES = ['a', 'b', 'c']
FLAGS = ['--store', 'memory']


def objects(run, name, client, mesh, done, flying):
    replay = Replay(run.hedged, [])
    try:
        replay.follow(client, mesh, done, flying)
        run.judge(name, False, 'the replay was content')
    except Wrong:
        run.judge(name, True)
    replay.close()


def prove(run):
    for _ in range(run.rounds):
        daemon = Daemon(run.hedged, FLAGS)
        replay = Replay(run.hedged, [])
        client = daemon.client()
        log, writers = write_for(daemon.port, MESHES, random.Random(run.chance.random()), 'w')
        threading.Event().wait(1.5)
        for writer in writers:
            writer.stop()
        done, flying = log.take()
        run.judge('nothing strange', not log.strange and not any(c.answer is None for c in flying),
                  f'{log.strange[:3]} {flying}')
        run.count('changes', len(done))
        for mesh in MESHES:
            run.attempt(f'{mesh} is what was acknowledged', replay.follow, client, mesh, done, flying)
            run.count('steps walked', run.attempt('undo and redo', replay.walk, client, mesh) or 0)
        mesh = max(MESHES, key=lambda m: len(replay.known[m].changes))
        lasting = [c for c in done if c.mesh == mesh and c.version
                   and c.version[0] == replay.known[mesh].incarnation]
        replay.close()
        for name, left in (('the first', 0), ('one', len(lasting) // 2), ('the last', -1)):
            objects(run, f'without {name} change', client, mesh,
                    [c for c in done if c is not lasting[left]], [])
        client.send('POST', f'/v1/meshes/{mesh}/edits', {'op': 'vertex_add', 'position': [9, 9, 9]})
        objects(run, 'a change that nobody made', client, mesh, done, [])
        client.close()
        run.judge('it stops', daemon.stop() == 0, daemon.log())
