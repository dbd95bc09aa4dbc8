"""golden.py - today's program opens stores that released programs made (D11).

    python3 tests/durable/golden.py --hedged build/hedged     makes tests/golden/NAME.db.gz

This is a compressed store with every kind of record; NAME.json says what is in it. NAME is the
version of the program, that of its tables, and that of its records if it is not 1. Every later program must open, verify, load, undo,
dump and edit each of these stores.
"""
import argparse
import glob
import gzip
import json
import os
import re
import shutil
import signal
import sqlite3
import subprocess
import tempfile
import time

from daemon import Daemon, Refused

FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'golden')
MOST = 64 << 10  # maximum bytes of a compressed store
SIDE = 200       # faces along a side of a mesh that is too large to be stored in its record


def facts(client, mesh):
    """Returns the facts about a mesh that every release can tell."""
    base = f'/v1/meshes/{mesh}'
    one = client.get(base).json()
    document = client.get(base + '/content').json()
    entries = client.get(base + '/edits?limit=1000').json()['entries']
    moments = {str(entry['revision']): entry['name'] for entry in entries if 'name' in entry}
    return {
        **({'moments': moments} if moments else {}),
        'name': one['name'], 'revision': one['revision'],
        'positions': document['vertices'][:50], 'faces': document['faces'][:50],
        'counts': [len(document['vertices']), len(document['faces'])],
        'attributes': sorted(client.get(base + '/attributes').json()['attributes'],
                             key=lambda a: (a['domain'], a['name'])),
        'materials': client.get(base + '/materials').json()['materials'],
    }


def told(client, mesh):
    """Returns the facts about the mesh now and after each possible undo and redo."""
    states = [facts(client, mesh)]
    for way in ('undo', 'redo'):
        while client.send('POST', f'/v1/meshes/{mesh}/{way}', {}).status == 200:
            states.append(facts(client, mesh))
    return states


def write(client):
    """Writes every kind of record, and everything else that a store keeps."""
    def ask(method, path, body=None, status=200, key=None):
        answer = client.send(method, '/v1/meshes' + path, body,
                             {'Idempotency-Key': key} if key else None)
        assert answer.status == status, (method, path, answer.status, answer.body)

    ask('POST', '?id=edited&name=first', {'shape': 'cube'}, 201, 'made')
    ask('POST', '/edited/edits', {'op': 'edge_split', 'edge': 3, 't': 0.25}, key='split')
    ask('POST', '/edited/edits', {'ops': [{'op': 'face_poke', 'face': 1},
                                                 {'op': 'face_poke', 'face': 2}]})
    ask('POST', '/edited/edits', {'op': 'vertex_move', 'vertex': 2, 'to': [2, 0.1, -3]})
    ask('PATCH', '/edited', {'name': 'edited \u00e9'})
    ask('PATCH', '/edited/edits/2', {'name': 'split \u00e9'})
    ask('PATCH', '/edited/edits/4', {'name': 'for a while'})
    ask('PATCH', '/edited/edits/4', {'name': None})
    ask('POST', '/edited/undo', {'steps': 2})
    ask('POST', '/edited/redo', {})
    ask('PUT', '/edited/attributes/faces/kind', {'type': 'int32', 'default': 7}, 201)
    ask('POST', '/edited/edits', {'op': 'material_set', 'name': 'red', 'base_color': [1, 0, 0, 1],
                                  'faces': [0, 1]})
    ask('POST', '/edited/edits', {'op': 'subdivide', 'scheme': 'linear'})
    ask('POST', '/edited/undo', {})
    job = client.send('POST', '/v1/meshes/edited/edits', {'op': 'subdivide', 'scheme': 'loop'},
                      {'Prefer': 'respond-async'})
    assert job.status == 202, job.body
    while client.get(job.headers['Location']).json()['state'] not in ('done', 'failed'):
        time.sleep(0.05)
    ask('POST', '?id=replaced', {'shape': 'tetrahedron'}, 201)
    ask('PUT', '/replaced?name=new', {'shape': 'cube'})
    ask('POST', '/replaced/edits', {'op': 'face_delete', 'face': 4})
    ask('POST', '/replaced/edits', {'op': 'compact'})
    ask('POST', '/replaced/edits', {'op': 'vertex_add', 'position': [1, 2, 3]})
    ask('POST', '?id=removed', {'shape': 'cube'}, 201)
    ask('DELETE', '/removed', None, 204)
    grid = [[row * (SIDE + 1) + column, row * (SIDE + 1) + column + 1,
             (row + 1) * (SIDE + 1) + column + 1, (row + 1) * (SIDE + 1) + column]
            for row in range(SIDE) for column in range(SIDE)]
    ask('PUT', '/staged', {'vertices': [[0, 0, 0]] * (SIDE + 1) ** 2, 'faces': grid}, 201)
    ask('POST', '/staged/edits', {'op': 'face_poke', 'face': 5})
    ask('POST', '/staged/edits', {'ops': [{'op': 'vertex_move', 'vertex': vertex, 'to': [1, 2, 3]}
                                          for vertex in range(1, (SIDE + 1) ** 2)]})


def hedged(program, *arguments):
    return subprocess.run([program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False)


def make(program):
    version = hedged(program, '--version').stdout.split()[1]
    with tempfile.TemporaryDirectory() as folder:
        store = 'sqlite:' + os.path.join(folder, 'store')
        daemon = Daemon(program, ['--store', store])
        client = daemon.client()
        write(client)
        made = hedged(program, '--store', store, '--backup', os.path.join(folder, 'golden.db'))
        assert made.returncode == 0, made.stdout
        ids = [mesh['id'] for mesh in client.get('/v1/meshes').json()['items']]
        tags = {mesh: client.get(f'/v1/meshes/{mesh}').headers['ETag'] for mesh in ids}
        states = {mesh: told(client, mesh) for mesh in ids}
        daemon.kill()
        database = sqlite3.connect(os.path.join(folder, 'golden.db'))
        tables = database.execute('PRAGMA user_version').fetchone()[0]
        records = int(database.execute('SELECT max(hex(substr(bytes, 5, 1))) FROM record')
                      .fetchone()[0], 16)
        database.close()
        suffix = '' if records == 1 else f'-records-{records}'
        name = os.path.join(FOLDER, f'{version}-tables-{tables}{suffix}')
        with open(os.path.join(folder, 'golden.db'), 'rb') as file:
            packed = gzip.compress(file.read(), 9, mtime=0)
        assert len(packed) <= MOST, len(packed)
        os.makedirs(FOLDER, exist_ok=True)
        with open(name + '.db.gz', 'wb') as file:
            file.write(packed)
        with open(name + '.json', 'w', encoding='utf-8') as file:
            json.dump({'tags': tags, 'meshes': states}, file, indent=0, sort_keys=True)
            file.write('\n')
    print(f'{name}.db.gz: {len(packed)} bytes, {len(ids)} meshes')


# --- the proof ---


def stop(run, daemon, what):
    daemon.process.send_signal(signal.SIGTERM)
    run.judge(f'{what} stops', daemon.wait() == 0)


def prove_one(run, packed):
    release = os.path.basename(packed)[:-len('.db.gz')]
    with open(packed[:-len('db.gz')] + 'json', encoding='utf-8') as file:
        wanted = json.load(file)
    with gzip.open(packed) as file:
        content = file.read()
    run.judge(f'{release} is small', os.path.getsize(packed) <= MOST, os.path.getsize(packed))
    folder = run.folder(release)
    os.makedirs(folder)
    database, saved = os.path.join(folder, 'hedge.db'), run.folder(release + '.dump')
    store = ['--store', 'sqlite:' + folder]
    with open(database, 'wb') as file:
        file.write(content)
    meshes = wanted['meshes']

    checked = hedged(run.hedged, '--verify', database)
    run.judge(f'{release} is verified', checked.returncode == 0
              and f'{len(meshes)} meshes whole, 0 not' in checked.stdout, checked.stdout)
    checked = hedged(run.hedged, *store, '--dump', saved)
    run.judge(f'{release} is dumped', checked.returncode == 0
              and sorted(os.listdir(saved)) == sorted([m + '.glb' for m in meshes]
                                                      + ['meshes.tsv']), checked.stdout)
    daemon = run.start(folder=folder)
    client = daemon.client()
    for order in ('name', 'modified', 'bytes'):
        listed = [mesh['id'] for mesh in client.get(f'/v1/meshes?sort={order}').json()['items']]
        names = sorted(meshes, key=lambda mesh: (meshes[mesh][0]['name'].lower(), mesh))
        run.judge(f'{release}: the list by {order}',
                  listed == names if order == 'name' else sorted(listed) == sorted(meshes), listed)
    for mesh, states in meshes.items():
        tag = client.get(f'/v1/meshes/{mesh}').headers['ETag']
        run.judge(f'{release}: the tag of {mesh}', tag == wanted['tags'][mesh], tag)
        now = told(client, mesh)
        run.judge(f'{release}: {mesh} and its undo and redo', now == states,
                  [(a, b) for a, b in zip(now, states) if a != b][:1])
        run.count('states', len(now))
        problems = client.get(f'/v1/meshes/{mesh}/check').json()
        run.judge(f'{release}: {mesh} is valid', problems['valid'], problems)
        answer = client.send('POST', f'/v1/meshes/{mesh}/edits',
                             {'op': 'vertex_add', 'position': [0, 0, 9]})
        run.judge(f'{release}: {mesh} can be edited', answer.status == 200, answer.body)
    again = client.send('POST', '/v1/meshes?id=edited&name=first', {'shape': 'cube'},
                        {'Idempotency-Key': 'made'})
    # A key is remembered for a day; after that, the repeated request is refused because the id is
    # taken.
    run.judge(f'{release}: a key is known or forgotten', again.status == 409
              or again.headers.get('Idempotency-Replayed') == 'true',
              f'{again.status} {again.headers}')
    stop(run, daemon, release)
    shutil.rmtree(folder)
    restored = run.folder(release + '.restored')
    back = run.folder(release + '.db')
    with open(back, 'wb') as file:
        file.write(content)
    done = hedged(run.hedged, '--store', 'sqlite:' + restored, '--restore', back)
    run.judge(f'{release} is restored', done.returncode == 0, done.stdout)
    refuse_newer(run, release, back)
    run.count('stores of releases')


def refuse_newer(run, release, file):
    """A store with tables of a future version must be refused, naming both versions."""
    folder = run.folder(release + '.newer')
    os.makedirs(folder)
    newer = os.path.join(folder, 'hedge.db')
    shutil.copy(file, newer)
    database = sqlite3.connect(newer)
    version = database.execute('PRAGMA user_version').fetchone()[0]
    database.execute('PRAGMA user_version = 99')
    database.close()
    said = []
    try:
        run.start(folder=folder).kill()
    except Refused as refused:
        said.append(refused.said)
    said += [hedged(run.hedged, '--store', 'sqlite:' + folder, flag, *rest).stdout
             for flag, *rest in (('--verify',), ('--dump', run.folder('none')),
                                 ('--backup', run.folder('none.db')))]
    said.append(hedged(run.hedged, '--store', 'sqlite:' + run.folder('none'), '--restore',
                       newer).stdout)
    known = {int(number) for text in said
             for number in re.findall(r'have version 99, .* up to version (\d+):', text)}
    run.judge(f'{release} with newer tables is refused with both versions',
              len(said) == 5 and len(known) == 1 and version <= known.pop() < 99
              and all('have version 99' in text for text in said), said)


def prove(run):
    for packed in sorted(glob.glob(os.path.join(FOLDER, '*.db.gz'))):
        prove_one(run, packed)
    run.expect_fired('stores of releases')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--hedged', required=True)
    make(parser.parse_args().hedged)


if __name__ == '__main__':
    main()
