"""writers.py - clients that change meshes in every possible way, and remember the answers.

A `Change` is one request. Its answer says where it belongs: the entity tag has the incarnation, and
the metadata counter and the revision after the change. A request that was sent and never answered
is in flight: it may have been executed or not.
"""
import json
import random
import threading
import time

from daemon import Answer, Client, Gone

SHAPES = [{'shape': 'icosphere', 'subdivisions': 1}, {'shape': 'cube'},
          {'shape': 'grid', 'columns': 6, 'rows': 5},
          {'shape': 'torus', 'major_segments': 8, 'minor_segments': 6},
          {'shape': 'uv_sphere', 'segments': 8, 'rings': 6}]
WRITTEN = (200, 201, 202, 204)
# The counts in the answer to an edit that found nothing to do, such as the dual of a mesh without
# faces, and made no revision; or to a list whose operations undo each other, which did make one.
NOTHING = b'"created":%s,"deleted":%s,"modified":%s' % (3 * (
    b'{"vertices":[],"edges":[],"faces":[]}',))


def did_nothing(change, answer):
    return (change.path == '/edits' and NOTHING in answer.body and change.kind != 'material'
            and b'"replaced":true' not in answer.body)


class Change:
    """A request that changes a mesh. `revisions` and `names` are what it adds to the two counters;
    `entry` is its entry in the history: its action and its operations."""

    def __init__(self, mesh, method, path, body=None, headers=None, revisions=1, names=0,
                 entry=None, name=None):
        self.mesh, self.method, self.path = mesh, method, path
        self.body, self.headers = body, dict(headers or {})
        self.revisions, self.names, self.entry, self.name = revisions, names, entry, name
        self.key = None                  # Idempotency-Key if the request may be sent again
        self.sent = self.answered = None  # times
        self.answer = self.version = None
        self.job = None

    def send(self, client, keyed=True):
        headers = dict(self.headers)
        if keyed and self.key:
            headers['Idempotency-Key'] = self.key
        return client.send(self.method, f'/v1/meshes/{self.mesh}{self.path}', self.body, headers)

    def creates(self):
        return self.method == 'PUT' and self.path.startswith('?')

    def deletes(self):
        return self.method == 'DELETE' and not self.path

    def __repr__(self):
        return f'{self.method} {self.mesh}{self.path} {self.body} -> {self.version}'


class Draw:
    """Draws random requests. Ids are small numbers, so that most of the elements are live; a
    request that names another one is refused and changes nothing."""

    def __init__(self, chance, label):
        self.chance, self.label, self.count = chance, label, 0
        self.steps = 3  # maximum steps of an undo

    def name(self):
        self.count += 1
        return f'{self.label}-{self.count}'

    def vertex(self):
        return self.chance.randrange(60)

    def number(self):
        return self.chance.uniform(-1, 1)

    def operation(self):
        c = self.chance
        edge, face = c.randrange(120), c.randrange(60)
        return c.choice([
            {'op': 'vertex_move', 'vertex': self.vertex(),
             'to': [self.number(), self.number(), self.number()]},
            {'op': 'edge_split', 'edge': edge, 't': c.uniform(0.2, 0.8)},
            {'op': 'edge_flip', 'edge': edge},
            {'op': 'edge_collapse', 'edge': edge},
            {'op': 'face_poke', 'face': face},
            {'op': 'face_extrude', 'face': face, 'distance': c.uniform(0.1, 0.5)},
            {'op': 'face_delete', 'face': face},
            {'op': 'vertex_add', 'position': [self.number(), self.number(), self.number()]},
            {'op': 'edge_bisect', 'edge': edge},
            {'op': 'vertex_delete', 'vertex': self.vertex()}])

    def change_edit(self, mesh):
        op = self.operation()
        return Change(mesh, 'POST', '/edits', op, entry=('edit', op['op']))

    def change_list(self, mesh):
        ops = [{'op': 'vertex_add', 'position': [self.number()] * 3, 'as': 'a'},
               {'op': 'vertex_move', 'vertex': '$a.vertex', 'to': [self.number()] * 3}]
        ops += [self.operation() for _ in range(self.chance.randrange(1, 3))]
        return Change(mesh, 'POST', '/edits', {'ops': ops},
                      entry=('edit', ','.join(op['op'] for op in ops)))

    def change_whole(self, mesh):
        op = self.chance.choice([
            {'op': 'transform', 'matrix': [1, 0, 0, self.number(), 0, 1, 0, self.number(),
                                           0, 0, 1, self.number(), 0, 0, 0, 1]},
            {'op': 'decimate', 'ratio': 0.5}, {'op': 'subdivide'}, {'op': 'compact'},
            {'op': 'reverse'}, {'op': 'dual'}])
        return Change(mesh, 'POST', '/edits', op, entry=('edit', op['op']))

    def change_compact(self, mesh):
        return Change(mesh, 'POST', '/edits', {'op': 'compact'}, entry=('edit', 'compact'))

    def change_material(self, mesh):
        op = {'op': 'material_set', 'name': self.chance.choice(['brass', 'glass', 'wood']),
              'base_color': [self.chance.random() for _ in range(4)]}
        return Change(mesh, 'POST', '/edits', op, entry=('edit', op['op']))

    def change_undo(self, mesh):
        steps = self.chance.randrange(1, self.steps + 1)
        return Change(mesh, 'POST', '/undo', {'steps': steps}, revisions=steps,
                      entry=('undo', None))

    def change_redo(self, mesh):
        return Change(mesh, 'POST', '/redo', {'steps': 1}, entry=('redo', None))

    def change_name(self, mesh):
        name = self.name()
        return Change(mesh, 'PATCH', '', {'name': name},
                      # The minimal answer is requested, because the summary could already show a
                      # later change of another client.
                      {'Content-Type': 'application/merge-patch+json', 'Prefer': 'return=minimal'},
                      revisions=0, names=1, name=name)

    def change_put(self, mesh):
        name = self.name()
        return Change(mesh, 'PUT', '?name=' + name, self.chance.choice(SHAPES), names=1,
                      entry=('replace', 'replace'), name=name)

    def change_delete(self, mesh):
        return Change(mesh, 'DELETE', '', revisions=0)

    def change_attribute(self, mesh):
        name = self.chance.choice(['heat', 'load'])
        body = {'type': 'double', 'value': self.number(), 'default': self.number()}
        return Change(mesh, 'PUT', '/attributes/vertices/' + name, body, entry=('edit', None))

    def change_values(self, mesh):
        name = self.chance.choice(['heat', 'load'])
        body = {'ids': [self.vertex()], 'value': self.number()}
        return Change(mesh, 'PATCH', '/attributes/vertices/' + name, body, entry=('edit', None))

    def change_no_attribute(self, mesh):
        return Change(mesh, 'DELETE', '/attributes/vertices/heat', entry=('edit', None))

    def change_job(self, mesh):
        change = self.change_whole(mesh)
        change.headers['Prefer'] = 'respond-async'
        return change

    KINDS = [('edit', 40), ('list', 12), ('whole', 3), ('compact', 1), ('undo', 10), ('redo', 6),
             ('name', 5), ('put', 2), ('delete', 0.5), ('attribute', 4), ('values', 6),
             ('no_attribute', 1), ('material', 3), ('job', 2)]

    def next(self, mesh, kinds=None):
        kinds = kinds or self.KINDS
        kind = self.chance.choices([k for k, _ in kinds], [w for _, w in kinds])[0]
        change = getattr(self, 'change_' + kind)(mesh)
        change.kind = kind
        # Requests that may be sent twice need a key; one that becomes a job has one, too.
        if change.method not in ('PUT', 'DELETE') and self.chance.random() < .5:
            change.key = self.name()
        return change


class Log:
    """What all writers did, in the order of the answers."""

    def __init__(self):
        self.lock = threading.Lock()
        self.done, self.open, self.refused, self.strange = [], [], {}, []

    def take(self):
        """Returns what was noted since the last call: changes that were answered, and those in
        flight."""
        with self.lock:
            done, self.done = self.done, []
            flying, self.open = self.open, []
        return done, flying


class Writer(threading.Thread):
    """A client that sends one change after another until it is stopped or the daemon is gone."""

    def __init__(self, port, log, meshes, draw, limit=None, kinds=None, patient=True, pause=None):
        super().__init__(daemon=True)
        self.client, self.log, self.meshes, self.draw = Client(port), log, meshes, draw
        self.limit, self.kinds, self.patient, self.pause = limit, kinds, patient, pause
        self.ending = threading.Event()
        self.count, self.sizes = 0, {}

    def stop(self):
        self.ending.set()
        self.join()
        self.client.close()

    def run(self):
        try:
            while not self.ending.is_set() and (self.limit is None or self.count < self.limit):
                self.step()
        except Gone:
            pass
        except Exception as error:  # pylint: disable=broad-except
            with self.log.lock:
                self.log.strange.append(f'a writer ended: {error!r}')

    def step(self):
        mesh = self.draw.chance.choice(self.meshes)
        change = self.draw.next(mesh, self.kinds)
        # A mesh that has grown too large to be compared quickly is often replaced by a new one.
        if self.sizes.get(mesh, 0) > 1500:
            self.sizes[mesh] = 0
            change = self.draw.change_put(mesh)
            change.kind = 'put'
        change.sent = time.monotonic()
        with self.log.lock:
            self.log.open.append(change)
        answer = change.send(self.client)
        if answer.status == 202:
            change.job = answer.headers['Location']
            answer = self.await_job(change)
        self.note(change, answer)

    def await_job(self, change):
        while True:
            answer = self.client.get(change.job)
            if answer.status != 200:
                return answer
            job = answer.json()
            if job.get('problem'):  # a failed job has no result
                return Answer(job['status'], answer.headers, json.dumps(job['problem']).encode())
            if job['state'] not in ('queued', 'running'):
                return self.client.get(change.job + '/result')

    def note(self, change, answer):
        change.answered, change.answer = time.monotonic(), answer
        with self.log.lock:
            self.log.open.remove(change)
            if answer.status in WRITTEN and did_nothing(change, answer):
                self.log.open.append(change)
            elif answer.status in WRITTEN:
                change.version = answer.version()
                if change.version or change.deletes():
                    self.log.done.append(change)
                    self.count += 1
                else:
                    self.log.strange.append(f'without a tag: {change!r} {answer.status}')
            else:
                code = answer.code()
                self.log.refused[code] = self.log.refused.get(code, 0) + 1
                if answer.status >= 500:
                    self.refuse(change, answer)
        if answer.status == 404 and answer.code() == 'no_such_mesh':
            self.create(change.mesh)
        if answer.status == 200 and b'"vertices":' in answer.body:
            made = answer.json().get('created', {})
            self.sizes[change.mesh] = max([self.sizes.get(change.mesh, 0),
                                           *(made.get('vertices', [])[-1:]
                                             if isinstance(made, dict) else [])])

    def refuse(self, change, answer):
        """Notes an answer of 500 or more as wrong; only a failing disk or a used-up budget may
        cause one."""
        if not self.patient:
            self.log.strange.append(f'{change!r}: {answer.status} {answer.body[:200]!r}')

    def create(self, mesh):
        change = self.draw.change_put(mesh)
        change.kind = 'put'
        change.sent = time.monotonic()
        with self.log.lock:
            self.log.open.append(change)
        self.note(change, change.send(self.client))


def write_for(port, meshes, chance, label, writers=4, **options):
    """Starts writers, which share a log; returns the log and the threads."""
    log = Log()
    threads = [Writer(port, log, meshes, Draw(random.Random(chance.random()), f'{label}.{i}'),
                      **options) for i in range(writers)]
    for thread in threads:
        thread.start()
    return log, threads

