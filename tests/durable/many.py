"""many.py - more meshes than fit into memory are made, listed, edited at random, and loaded after
restarts.

ROUNDS is the number of meshes. Each client has meshes of its own and a model of them, so that every
answer, every page of the list and every start is compared with what must be there: names, tags,
counts, the position of a vertex, where undo and redo lead. The memory budget is 256 MiB, into which
100,000 small meshes do not fit, and less for fewer meshes.
"""
import itertools
import os
import random
import threading
import time

from backups import maintain
from daemon import Gone

CLIENTS = 16
MESHES, BUDGET = 100000, 256 << 20
LEAST_BUDGET = 16 << 20
PROGRAM = 64 << 20  # resident bytes that a smaller budget is not expected to keep the program in
EDITS = 1           # edits of each mesh, on average, from one start of the daemon to the next
PAGES = (1000, 333, 10000)
SHAPES = [({'shape': 'cube'}, (8, 12, 6)),
          ({'shape': 'icosphere', 'subdivisions': 1}, (42, 120, 80)),
          ({'shape': 'grid', 'columns': 4, 'rows': 4}, (25, 40, 16))]


class Wrong(Exception):
    """Raised if an answer differs from the model."""


class Mesh:
    """The model of one mesh. A state is its counts and the position to which vertex 0 was moved."""

    def __init__(self, name, shape, client):
        self.id, self.name, self.shape, self.client = name, '', shape, client
        self.incarnation, self.names, self.revision = None, 1, 0
        self.done, self.undone = [], []

    def path(self, rest=''):
        return f'/v1/meshes/{self.id}{rest}'

    def expect(self, answer, status):
        """Requires that the entity tag of the answer names the state of the model."""
        version = answer.version()
        if self.incarnation is None and version:
            self.incarnation = version[0]
        if answer.status != status or version != (self.incarnation, self.names, self.revision):
            raise Wrong(f'{self.id}: {answer.status} {version} {answer.body[:200]!r}, not {status} '
                        f'{(self.incarnation, self.names, self.revision)}')

    def create(self, client):
        answer = client.send('PUT', self.path(), self.shape[0])
        self.incarnation, self.names, self.revision, self.name = None, 1, 1, ''
        self.done, self.undone = [(*self.shape[1], None)], []
        self.expect(answer, 201)

    def edit(self, client, chance):
        vertices, edges, faces, place = self.done[-1]
        kind = chance.choice(['move', 'add', 'bisect'])
        if kind == 'move':
            place = [chance.uniform(-1, 1) for _ in range(3)]
            body = {'op': 'vertex_move', 'vertex': 0, 'to': place}
        elif kind == 'add':
            vertices += 1
            body = {'op': 'vertex_add', 'position': [0, 0, chance.uniform(-1, 1)]}
        else:
            vertices, edges = vertices + 1, edges + 1
            body = {'op': 'edge_bisect', 'edge': chance.randrange(self.shape[1][1])}
        answer = client.send('POST', self.path('/edits'), body)
        self.revision += 1
        self.done.append((vertices, edges, faces, place))
        self.undone = []
        self.expect(answer, 200)

    def step(self, client, which):
        source, target = self.done, self.undone
        if which == 'redo':
            source, target = target, source
        if len(source) == (1 if which == 'undo' else 0):
            answer = client.send('POST', self.path('/' + which), {})
            if answer.status != 409:
                raise Wrong(f'{self.id}: {which} of nothing: {answer.status} {answer.body[:200]!r}')
            return
        answer = client.send('POST', self.path('/' + which), {})
        self.revision += 1
        target.append(source.pop())
        self.expect(answer, 200)

    def rename(self, client, _):
        self.names += 1
        self.name = f'{self.id} {self.names}'  # the present name would be no change
        self.expect(client.send('PATCH', self.path(), {'name': self.name},
                                {'Content-Type': 'application/merge-patch+json'}), 200)

    def remove(self, client):
        answer = client.send('DELETE', self.path())
        gone = client.get(self.path())
        if answer.status != 204 or gone.status != 404:
            raise Wrong(f'{self.id}: DELETE {answer.status}, then GET {gone.status}')
        self.create(client)

    def change(self, client, chance):
        kind = chance.choices(['edit', 'undo', 'redo', 'rename', 'remove'], [60, 15, 10, 10, 5])[0]
        if kind in ('undo', 'redo'):
            self.step(client, kind)
        elif kind == 'remove':
            self.remove(client)
        else:
            getattr(self, kind)(client, chance)

    def counts(self):
        vertices, edges, faces, _ = self.done[-1]
        return {'vertices': vertices, 'halfedges': 2 * edges, 'edges': edges, 'faces': faces}

    def read(self, client):
        answer = client.get(self.path())
        self.expect(answer, 200)
        counts = answer.json()['counts']
        if any(counts[name] != count for name, count in self.counts().items()):
            raise Wrong(f'{self.id}: {counts}, not {self.counts()}')
        place = self.done[-1][3]
        if place is not None:
            found = client.get(self.path('/vertices/0')).json()['position']
            if found != place:
                raise Wrong(f'{self.id}: vertex 0 at {found}, not {place}')

    def compare(self, item):
        expected = {'id': self.id, 'name': self.name, 'revision': self.revision,
                    'counts': self.counts()}
        # sizes and times are those of the server, which nobody else knows
        if {name: item.get(name) for name in expected} != expected or \
                set(item) != {*expected, 'memory_bytes', 'modified'}:
            raise Wrong(f'listed as {item}, not {expected}')


def walk(client, limit):
    """Returns the pages of the list of meshes."""
    cursor = ''
    while cursor is not None:
        answer = client.get(f'/v1/meshes?limit={limit}{cursor}')
        if answer.status != 200:
            raise Wrong(f'the list: {answer.status} {answer.body[:200]!r}')
        page = answer.json()
        yield page
        cursor = page['next'] and '&cursor=' + page['next']
        if cursor and len(page['items']) != limit:
            raise Wrong(f'a page of {len(page["items"])} of {limit} that is not the last')


def check_list(client, meshes, limit):
    items = itertools.chain.from_iterable(page['items'] for page in walk(client, limit))
    for mesh, item in itertools.zip_longest(meshes, items):
        if mesh is None or item is None:
            raise Wrong(f'the list ends at {mesh and mesh.id}, {item}')
        mesh.compare(item)


def walk_beside(client, ids, ending, wrong):
    """Reads the list while meshes change: it must be in order, have each mesh at most once, and
    none that never existed."""
    try:
        while not ending.is_set():
            found = [item['id'] for page in walk(client, 1000) for item in page['items']]
            if found != sorted(set(found)) or not ids.issuperset(found):
                raise Wrong('the list is out of order, or has what is not there')
    except (Wrong, Gone) as error:
        wrong.append(f'{error!r}')


class Many:
    def __init__(self, run):
        self.run, self.folder = run, run.folder()
        self.budget = max(LEAST_BUDGET, min(BUDGET, BUDGET * run.rounds // MESHES))
        names = [f'm{run.chance.getrandbits(40):010x}.{i}' for i in range(run.rounds)]
        self.meshes = [Mesh(name, run.chance.choice(SHAPES), i % CLIENTS)
                       for i, name in enumerate(sorted(names))]
        self.daemon = self.client = None

    def start(self, how):
        begun = time.monotonic()
        self.daemon = self.run.start(['--memory-budget', str(self.budget)], self.folder)
        self.client = self.daemon.client()
        self.client.get('/v1/meshes?limit=1')
        self.run.count(f'ms from start to list, {how}', round(1000 * (time.monotonic() - begun)))

    def settle(self):
        """Checks the state of the daemon before it is stopped or killed."""
        resident, counted = self.daemon.memory()[1], self.counted()
        self.run.judge('resident memory is within the budget', resident <= max(self.budget, PROGRAM),
                       f'{resident} of {self.budget}')
        self.run.judge('counted memory is within the budget', counted <= self.budget,
                       f'{counted} of {self.budget}')
        self.run.counts['MiB resident at most'] = max(
            self.run.counts.get('MiB resident at most', 0), resident >> 20)

    def counted(self):
        return self.client.get('/v1/meshes?limit=1').json()['memory_bytes']

    def metric(self, name):
        for line in self.client.get('/metrics').body.decode().splitlines():
            if line.startswith(name + ' '):
                return int(float(line.split()[1]))
        raise Wrong(f'/metrics has no {name}')

    def each(self, what, meshes, function):
        """Calls function(mesh, client, chance) on each mesh; all clients work at once, each on
        meshes of its own."""
        wrong, chances = [], [random.Random(self.run.chance.random()) for _ in range(CLIENTS)]
        lists = [[m for m in meshes if m.client == i] for i in range(CLIENTS)]

        def work(mine, chance):
            client = self.daemon.client()
            try:
                for mesh in mine:
                    function(mesh, client, chance)
            except Exception as error:  # pylint: disable=broad-except
                wrong.append(f'{error!r}')
            client.close()

        threads = [threading.Thread(target=work, args=pair) for pair in zip(lists, chances)]
        begun = time.monotonic()
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        took = time.monotonic() - begun
        if not self.daemon.is_alive():
            wrong.append(f'the daemon ended: {self.daemon.wait()} {self.daemon.log()[-500:]}')
        self.run.judge(what, not wrong, wrong[:1] + wrong[-1:])
        self.run.count(what, len(meshes))
        self.run.count(f'us for one of {what}', round(1e6 * took / max(1, len(meshes))))

    def create_all(self):
        order = self.run.chance.sample(self.meshes, len(self.meshes))
        self.each('creates', order, lambda mesh, client, _: mesh.create(client))
        kept = self.metric('hedge_meshes_in_memory')
        self.run.judge('memory does not hold them all', kept < len(order),
                       f'{kept} of {len(order)}')
        self.run.count('meshes in memory after the creations', kept)

    def list_all(self):
        for limit in PAGES:
            begun = time.monotonic()
            self.run.attempt(f'the list by {limit}', check_list, self.client, self.meshes, limit)
            self.run.count(f'ms for the list by {limit}', round(1000 * (time.monotonic() - begun)))

    def edit(self):
        meshes = self.run.chance.choices(self.meshes, k=EDITS * len(self.meshes))
        ending, wrong = threading.Event(), []
        lister = threading.Thread(target=walk_beside, args=(
            self.daemon.client(), {mesh.id for mesh in self.meshes}, ending, wrong))
        lister.start()
        self.each('edits', meshes, lambda mesh, client, chance: mesh.change(client, chance))
        ending.set()
        lister.join()
        self.run.judge('the list beside edits', not wrong, wrong)

    def read(self):
        meshes = self.run.chance.sample(self.meshes, max(1, len(self.meshes) // 10))
        self.each('reads', meshes, lambda mesh, client, _: mesh.read(client))


def prove(run):
    many = Many(run)
    many.start('empty')
    many.create_all()
    many.list_all()
    many.edit()
    for how in ('stopped', 'killed'):
        many.read()
        many.settle()
        begun = time.monotonic()
        if how == 'killed':
            run.judge('it is killed', many.daemon.kill())
        else:
            run.judge('it stops', many.daemon.stop() == 0, many.daemon.log())
            run.count('ms to stop', round(1000 * (time.monotonic() - begun)))
        many.start(how)
        many.list_all()
        many.read()
        many.edit()
    many.list_all()
    many.settle()
    run.judge('it stops at the end', many.daemon.stop() == 0, many.daemon.log())
    run.count('MiB on disk', os.path.getsize(os.path.join(many.folder, 'hedge.db')) >> 20)
    begun = time.monotonic()
    status, said = maintain(run, many.folder, '--verify')
    run.judge('all meshes are whole', status == 0, said[-500:])
    run.count('s to verify', round(time.monotonic() - begun))
