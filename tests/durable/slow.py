"""slow.py - on a disk that takes 200 ms to sync, queues must not grow without limit (D12)."""
import os
import random
import threading

from replay import Replay
from writers import write_for

MESHES = ['a', 'b', 'c', 'd']
WAL = 256 << 20
GROWTH = 400 << 20  # bytes, for the queue of 64 MiB, its part being committed, the history
SIDE = 80           # faces along a side of a grid that is moved again and again, 0.4 MB a record
MOVE = {'op': 'transform', 'matrix': [1, 0, 0, .1, 0, 1, 0, .1, 0, 0, 1, .1, 0, 0, 0, 1]}
CLIENTS = 256       # number of clients, each with one request under way: more than the queue holds
SECONDS = 8


def move_often(run, daemon, mesh, ending):
    client = daemon.client()
    while not ending.is_set():
        answer = client.send('POST', f'/v1/meshes/{mesh}/edits', MOVE)
        if answer.status == 503:
            run.count('answers of 503')
            if answer.code() != 'store_behind' or not answer.headers.get('Retry-After'):
                run.judge('503 says why and when', False, f'{answer.headers} {answer.body}')
            ending.wait(1)
        else:
            run.count('large edits')
            if answer.status != 200:
                run.judge('a large edit', False, answer.body)
    client.close()


def load_often(run, daemon, ending):
    """Loads meshes all the time, so that old contents are read while new ones are written."""
    client = daemon.client()
    while not ending.is_set():
        for mesh in MESHES:
            client.get(f'/v1/meshes/{mesh}')
            run.count('reads')
    client.close()


def prove(run):
    for _ in range(run.rounds):
        folder = run.folder()
        report = run.folder('report')
        switch = run.folder('switch')
        daemon = run.start(faults={'FAULT_SLOW': 200, 'FAULT_REPORT': report,
                                   'FAULT_WHEN': switch})
        client = daemon.client()
        for i in range(CLIENTS):
            client.send('PUT', f'/v1/meshes/big{i}',
                        {'shape': 'grid', 'columns': SIDE, 'rows': SIDE})
        with open(switch, 'w', encoding='ascii'):
            pass
        ending = threading.Event()
        threads = [threading.Thread(target=move_often, args=(run, daemon, f'big{i}', ending))
                   for i in range(CLIENTS)]
        threads.append(threading.Thread(target=load_often, args=(run, daemon, ending)))
        log, writers = write_for(daemon.port, MESHES, random.Random(run.chance.random()), 'w')
        before = daemon.memory()[0]
        for thread in threads:
            thread.start()
        largest = 0
        for _ in range(10 * SECONDS):
            ending.wait(0.1)
            largest = max(largest, os.path.getsize(os.path.join(folder, 'hedge.db-wal')))
        ending.set()
        for thread in threads:
            thread.join()
        for writer in writers:
            writer.stop()
        peak = daemon.memory()[1]
        done, flying = log.take()
        run.count('changes', len(done))
        run.count('MiB of -wal at most', largest >> 20)
        run.count('MiB of growth at most', (peak - before) >> 20)
        run.judge('the -wal is bounded', largest <= WAL, largest)
        run.judge('memory is bounded', peak - before <= GROWTH, peak - before)
        run.judge('nothing strange', not log.strange, log.strange[:2])
        run.judge('writers go on', len(done) > 4, len(done))
        os.remove(switch)
        replay = Replay(run.hedged, [])
        for mesh in MESHES:
            run.attempt(mesh, replay.follow, client, mesh, done, flying)
        replay.close()
        run.judge('it stops', daemon.stop() == 0, daemon.log())
        with open(report, encoding='ascii') as file:
            run.count('slow', file.read().count('fired slow'))
    run.expect_fired('slow', 'answers of 503', 'large edits')
