"""locks.py - only one daemon may use a folder (D8)."""
from daemon import Daemon, Refused


def prove(run):
    """A second daemon must be refused and name the process that uses the folder; after kill -9 a
    third one must start."""
    for number in range(run.rounds):
        daemon = run.start()
        client = daemon.client()
        path = f'/v1/meshes/m{number}'
        made = client.send('PUT', path, {'shape': 'cube'})
        run.judge('the first daemon writes', made.status == 201, made.body)
        try:
            second = run.start()
            second.kill()
            run.judge('a second daemon is refused', False, 'it started')
        except Refused as refused:
            run.count('refused')
            run.judge('a second daemon is refused', refused.status == 1, refused)
            run.judge('it names the first process', f'process {daemon.process.pid}' in refused.said,
                      refused)
        edit = client.send('POST', path + '/edits', {'op': 'face_poke', 'face': 0})
        run.judge('the first one goes on', edit.status == 200, edit.body)
        # A second daemon may run at the same time, if it has another folder.
        other = Daemon(run.hedged, ['--store', 'sqlite:' + run.folder('other')])
        run.judge('another folder is another store',
                  other.client().get(path).status == 404 and other.stop() == 0, other.log())
        run.judge('killed', daemon.kill())
        run.count('kills')
    last = run.start()
    names = [item['id'] for item in last.client().get('/v1/meshes?limit=10000').json()['items']]
    run.judge('a lock that was left behind holds nobody up',
              sorted(names) == sorted(f'm{n}' for n in range(run.rounds)), names)
    run.judge('stopped', last.stop() == 0, last.log())
    run.expect_fired('refused', 'kills')
