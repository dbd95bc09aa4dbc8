"""stops.py - a daemon is told to stop while the disk hangs: it must stop in time, say what it could
not write, and lose nothing.
"""
import random
import signal
import threading
import time

from daemon import Gone

HANGS = 9000   # milliseconds that each sync takes: longer than a stop may
SECONDS = 5.5  # seconds that a stop may take


def ask(client, answers, *request):
    try:
        answers.append(client.send(*request).status)
    except Gone:
        answers.append(None)


def prove(run):
    for number in range(run.rounds):
        switch = run.folder(f'switch{number}')
        daemon = run.start(faults={'FAULT_SLOW': HANGS, 'FAULT_WHEN': switch})
        client = daemon.client()
        client.send('PUT', '/v1/meshes/m', {'shape': 'cube'})
        edits = random.Random(run.chance.random()).randrange(1, 30)
        for i in range(edits):
            tag = client.send('POST', '/v1/meshes/m/edits',
                              {'op': 'vertex_move', 'vertex': 0, 'to': [i, i, i]}).version()
        with open(switch, 'w', encoding='ascii'):
            pass
        # A change hangs in its sync, and a request that looks for a mesh on the disk waits behind
        # it.
        answers, threads = [], []
        for request in (('POST', '/v1/meshes/m/undo', {}), ('GET', '/v1/meshes/none')):
            threads.append(threading.Thread(target=ask, args=(daemon.client(), answers, *request)))
            threads[-1].start()
            time.sleep(0.3)
        run.judge('both wait for the disk', not answers, answers)
        begun = time.monotonic()
        daemon.process.send_signal(signal.SIGTERM)
        status = daemon.wait()
        took = time.monotonic() - begun
        for thread in threads:
            thread.join()
        run.judge('it stops in time', took < SECONDS, took)
        run.judge('its status is 1', status == 1, status)
        run.judge('it says that work was abandoned', 'were abandoned' in daemon.log(), daemon.log())
        run.judge('nothing that hung was answered as done', not {200, 404} & set(answers), answers)
        run.count('stops with work under way', status == 1)
        daemon = run.start()
        now = daemon.client().get('/v1/meshes/m').version()
        # The undo was not answered, so it may be there or not.
        run.judge('what was answered is there', now in (tag, (*tag[:2], tag[2] + 1)), (tag, now))
        run.count('edits', edits)
        daemon.process.send_signal(signal.SIGTERM)
        run.judge('without work its status is 0', daemon.wait() == 0)
    run.expect_fired('stops with work under way')
