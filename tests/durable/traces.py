"""traces.py - no answer is sent before the sync that covers it (D1), as seen by strace.

Nearly every change carries a name or a key that is unique and can be found again in what is written
to the write-ahead log (-wal). Its write is the first one that contains this mark, and its sync is
the first one of the -wal that begins after that write: only when this sync has returned may an
answer, an event or a list show the change. A removal leaves no such mark: it counts as written by
the first write to the -wal after its request came.

Over TLS nobody can read what is sent. So one client sends changes one after the other on a connection
that it has used before: what the daemon sends between the arrival of a request and that of the next
one is its answer.
"""
import contextlib
import http.client
import os
import random
import re
import ssl
import subprocess
import threading

from daemon import PATIENCE, Client

MESHES = ['a', 'b', 'c']
CALLS = 'fdatasync,fsync,pwrite64,write,writev,sendto,sendmsg,sendfile,recvfrom,recvmsg,read'
RECEIVE = ('recvfrom', 'recvmsg', 'read')
LINE = re.compile(r'^(\d+) +(?:<\.\.\. )?(\w+)(?: resumed>|\()(.*)$')
FILE = re.compile(r'^\d+<((?:\\x[0-9a-f]{2})*)>')
DATA = re.compile(r'"((?:\\x[0-9a-f]{2})*)"')
REQUEST = re.compile(rb'X-Request-Id: (t\d+)', re.I)
EVENT = re.compile(rb'id: ([0-9a-f]+)\.(\d+)')


def unhex(text):
    return bytes.fromhex(text.replace('\\x', ''))


class Seen:
    """A request, and the version in its answer: (incarnation, metadata counter, revision)."""

    def __init__(self, kind):
        self.kind, self.mark, self.shows, self.items, self.gone = kind, None, [], [], None


class Traffic:
    """Clients that write, read and listen, whose requests have unique names."""

    def __init__(self, daemon, chance):
        self.daemon, self.chance = daemon, chance
        self.lock, self.number = threading.Lock(), 0
        self.seen, self.marks, self.removals, self.creations = {}, {}, [], []
        self.ending = threading.Event()

    def ask(self, client, kind, method, path, body=None, headers=None):
        with self.lock:
            self.number += 1
            name = f't{self.number}'
            seen = self.seen[name] = Seen(kind)
        answer = client.send(method, path, body, {**(headers or {}), 'X-Request-Id': name})
        if answer.version():
            seen.shows.append(answer.version())
        return name, seen, answer

    def write(self, chance, count):
        client = self.daemon.client()
        for i in range(count):
            mesh = f'/v1/meshes/{chance.choice(MESHES)}'
            draw = chance.random()
            if draw < 0.06:
                name, seen, answer = self.ask(client, 'delete', 'DELETE', mesh)
                if answer.status == 204:
                    self.removals.append((name, mesh))
                continue
            x = chance.random()
            if draw < 0.16:
                mark = f'name-{x}'.encode()
                _, seen, answer = self.ask(client, 'rename', 'PATCH', mesh,
                                           {'name': mark.decode()})
            else:
                mark = f'key-{x}'.encode()
                body = {'op': 'vertex_move', 'vertex': i % 8, 'to': [x, 0, 0]}
                headers = {'Idempotency-Key': mark.decode()} if draw < 0.95 else {}
                if draw > 0.8:
                    headers['Prefer'] = 'respond-async'
                _, seen, answer = self.ask(client, 'list' if draw < 0.3 else 'edit', 'POST',
                                           mesh + '/edits',
                                           {'ops': [body]} if draw < 0.3 else body, headers)
                if answer.status == 202:
                    self.await_job(client, mark, answer.headers['Location'])
                    continue
            if answer.status == 404:
                mark = f'made-{x}'.encode()
                name, seen, answer = self.ask(client, 'create', 'PUT',
                                              f'{mesh}?name={mark.decode()}', {'shape': 'cube'},
                                              {'If-None-Match': '*'})
                if answer.status == 201:
                    self.creations.append((name, mesh))
            if answer.status in (200, 201):
                seen.mark = mark
                with self.lock:
                    self.marks[answer.version()] = mark
        client.close()

    def await_job(self, client, mark, path):
        """Waits for a job. Only the answer that says `done` must wait for the sync; those before
        show nothing."""
        while True:
            _, seen, answer = self.ask(client, 'job', 'GET', path)
            if answer.json()['state'] == 'done':
                result = client.get(path + '/result')
                if result.version():
                    seen.shows.append(result.version())
                    with self.lock:
                        self.marks[result.version()] = mark
                return
            if answer.json()['state'] not in ('queued', 'running'):
                return

    def read(self, chance):
        client = self.daemon.client()
        while not self.ending.is_set():
            mesh = chance.choice(MESHES)
            if chance.random() < 0.4:
                _, seen, answer = self.ask(client, 'page of meshes', 'GET', '/v1/meshes')
                seen.items = [(item['name'], item['revision']) for item in answer.json()['items']]
            else:
                _, seen, answer = self.ask(client, 'read', 'GET', f'/v1/meshes/{mesh}/vertices/1')
                if answer.status == 404:
                    seen.kind, seen.gone = '404', f'/v1/meshes/{mesh}'
        client.close()

    def listen(self):
        """Reads events; they are found in the trace by their ids."""
        while not self.ending.is_set():
            connection = http.client.HTTPConnection('127.0.0.1', self.daemon.port, timeout=0.5)
            try:
                connection.request('GET', f'/v1/meshes/{MESHES[0]}/events')
                reply = connection.getresponse()
                while not self.ending.is_set() and reply.read1(1 << 16):
                    pass
            except (OSError, http.client.HTTPException):
                pass
            connection.close()

    def run(self, count):
        writers = [threading.Thread(target=self.write, args=(random.Random(self.chance.random()),
                                                             count)) for _ in range(4)]
        others = [threading.Thread(target=self.read, args=(random.Random(self.chance.random()),))
                  for _ in range(2)] + [threading.Thread(target=self.listen)]
        for thread in writers + others:
            thread.start()
        for thread in writers:
            thread.join()
        self.ending.set()
        for thread in others:
            thread.join()


class Trace:
    """What strace wrote: the order of writes to the -wal, its syncs, and the bytes that were sent.
    """

    def __init__(self, path):
        self.written, self.syncs, self.sent, self.came, self.events = [], [], {}, {}, []
        self.received, self.answered = [], []  # all bytes on sockets
        under_way = {}
        with open(path, encoding='latin-1') as file:
            for at, line in enumerate(file):
                found = LINE.match(line)
                if not found:
                    continue
                thread, call, rest = found.groups()
                resumed = ' resumed>' in line[:60]
                named = FILE.match(rest)
                file_name = unhex(named[1]).decode() if named else ''
                if call in ('fdatasync', 'fsync'):
                    self.sync(at, thread, rest, resumed or file_name, under_way)
                elif file_name.endswith('hedge.db-wal'):
                    self.written.append((at, self.bytes(rest)))
                elif '/' not in file_name:
                    data = self.bytes(rest)
                    if data and file_name.startswith('socket:'):
                        (self.received if call in RECEIVE else self.answered).append(at)
                    self.look(at, call, data)

    def sync(self, at, thread, rest, where, under_way):
        """Notes a sync. `where` is the name of the file, or True for the end of a call that began
        before."""
        if where is not True:
            if not where.endswith('hedge.db-wal'):
                return
            under_way[thread] = at
            if '<unfinished' in rest:
                return
        begun = under_way.pop(thread, None)
        if begun is not None and '= 0' in rest:
            self.syncs.append((begun, at))

    @staticmethod
    def bytes(text):
        return b''.join(unhex(part) for part in DATA.findall(text))

    def look(self, at, call, data):
        if call in RECEIVE:
            for name in REQUEST.findall(data):
                self.came[name.decode()] = at
        else:
            for name in REQUEST.findall(data):
                self.sent.setdefault(name.decode(), at)
            for incarnation, revision in EVENT.findall(data):
                self.events.append((at, incarnation.decode(), int(revision)))

    def covered(self, written, later=0):
        """Returns when the sync returned that covers a write; `later` counts further syncs after
        it."""
        after = [returned for begun, returned in self.syncs if begun > written]
        return after[later] if len(after) > later else None

    def find(self, mark):
        return next((at for at, data in self.written if mark in data), None)


class Verdict:
    """Compares the answers that were sent with the changes that were covered by a sync."""

    def __init__(self, run, traffic, trace, later):
        self.run, self.trace, self.later, self.early, self.checked = run, trace, later, [], {}
        self.when = {}  # by incarnation: (names, revision, is a rename, covered)
        self.named = {mark.decode(): version[:2] for version, mark in traffic.marks.items()}
        for (incarnation, names, revision), mark in traffic.marks.items():
            written = trace.find(mark)
            cover = written and trace.covered(written, later)
            if cover:
                self.when.setdefault(incarnation, []).append(
                    (names, revision, mark.startswith(b'name-'), cover))
        for name, seen in traffic.seen.items():
            if name in trace.sent:
                self.judge(name, seen, traffic)
        for at, incarnation, revision in trace.events:
            self.compare('event', at, self.until(incarnation, None, revision), f'r{revision}')

    def until(self, incarnation, names, revision):
        """Returns when everything was covered that this version shows. Without `names` this is the
        revision alone, which later renames do not change."""
        return max((cover for n, r, renames, cover in self.when.get(incarnation, ())
                    if r <= revision and (not renames if names is None else n <= names)),
                   default=None)

    def compare(self, kind, sent, covered, what):
        if covered is None:
            return
        self.checked[kind] = self.checked.get(kind, 0) + 1
        if sent < covered:
            self.early.append(f'{kind} {what}: sent at line {sent}, covered at {covered}')

    def judge(self, name, seen, traffic):
        sent = self.trace.sent[name]
        for version in seen.shows:
            self.compare(seen.kind, sent, self.until(*version), f'{name} {version}')
        for item, revision in seen.items:
            if item in self.named:
                incarnation, names = self.named[item]
                self.compare(seen.kind, sent, self.until(incarnation, names, revision),
                             f'{name} {item} r{revision}')
        if seen.kind == 'delete' and any(name == n for n, _ in traffic.removals):
            self.compare(seen.kind, sent, self.removed_at(name), name)
        elif seen.gone:
            # The mesh may be removed again before this answer is sent, so one removal that was
            # covered in time is enough.
            covered = [self.removed_at(n) for n in self.explain(name, seen, traffic)]
            self.compare(seen.kind, sent, min(filter(None, covered), default=None), name)

    def removed_at(self, name):
        """Returns when the removal was covered that this request made."""
        came = self.trace.came.get(name)
        written = next((at for at, _ in self.trace.written if came is not None and at > came), None)
        return written and self.trace.covered(written, self.later)

    def explain(self, name, seen, traffic):
        """Returns the removals that may be why this request found no mesh: they came before its
        answer, and no creation lies completely between them and the request."""
        came, sent = self.trace.came, self.trace.sent
        created = [n for n, mesh in traffic.creations
                   if mesh == seen.gone and n in sent and sent[n] < came.get(name, 0)]
        return [n for n, mesh in traffic.removals
                if mesh == seen.gone and n in sent and came.get(n, sent[name]) < sent[name]
                and not any(came.get(c, 0) > sent[n] for c in created)]


@contextlib.contextmanager
def traced(daemon, path):
    """Runs strace on the daemon during the block, which writes the daemon's calls to `path`."""
    strace = subprocess.Popen(['strace', '-f', '-y', '-xx', '-s', '70000', '-e', 'trace=' + CALLS,
                               '-e', 'signal=none', '-o', path, '-p', str(daemon.process.pid)],
                              stderr=subprocess.PIPE, text=True)
    said = strace.stderr.readline()
    if 'attached' not in said:
        raise RuntimeError('strace: ' + said)
    try:
        yield
    finally:
        strace.terminate()
        strace.wait()


class SecureClient(Client):
    """A client that speaks TLS and accepts any certificate."""

    def __init__(self, port):
        super().__init__(port)
        self.connection = http.client.HTTPSConnection(
            '127.0.0.1', port, timeout=PATIENCE, context=ssl._create_unverified_context())


def make_certificate(run):
    certificate, key = run.folder('certificate.pem'), run.folder('key.pem')
    subprocess.run(['openssl', 'req', '-x509', '-newkey', 'ec', '-pkeyopt',
                    'ec_paramgen_curve:prime256v1', '-nodes', '-subj', '/CN=localhost', '-days', '2',
                    '-keyout', key, '-out', certificate], check=True, capture_output=True)
    return ['--tls-cert', certificate, '--tls-key', key]


def change_over_tls(client, chance):
    """Sends changes and returns their marks, in order."""
    marks = []
    for i in range(30):
        x = chance.random()
        if i % 5 == 4:
            mark = f'name-{x}'
            answer = client.send('PATCH', '/v1/meshes/a', {'name': mark})
        else:
            mark = f'key-{x}'
            answer = client.send('POST', '/v1/meshes/a/edits',
                                 {'op': 'vertex_move', 'vertex': i % 8, 'to': [x, 0, 0]},
                                 {'Idempotency-Key': mark})
        if answer.status == 200:
            marks.append(mark.encode())
    return marks


def early_over_tls(trace, marks, later):
    """Returns how many answers came before the sync that covers their change, and how many there
    were."""
    early = found = 0
    for mark in marks:
        written = trace.find(mark)
        covered = written and trace.covered(written, later)
        came = max((at for at in trace.received if written and at < written), default=None)
        answered = next((at for at in trace.answered if came is not None and at > came), None)
        if covered and answered:
            found += 1
            early += answered < covered
    return early, found


def trace_tls_round(run, number):
    daemon = run.start(make_certificate(run), folder=run.folder(f'secure-{number}'))
    client = SecureClient(daemon.port)
    client.send('PUT', '/v1/meshes/a', {'shape': 'cube'})
    local = client.connection.sock
    path = run.folder('trace')
    with traced(daemon, path):
        marks = change_over_tls(client, run.chance)
    run.judge('all is sent on one connection', client.connection.sock is local, '')
    client.close()
    run.judge('it stops', daemon.stop() == 0, daemon.log())
    trace = Trace(path)
    early, found = early_over_tls(trace, marks, 0)
    run.count('answers over TLS', found)
    run.judge('each change over TLS is found', found == len(marks) > 20, (found, len(marks)))
    run.judge('no answer over TLS was early', early == 0, f'{early} of {found} were')
    run.count('seen as early over TLS with the next sync', early_over_tls(trace, marks, 1)[0])
    os.remove(path)


def trace_round(run, number):
    folder = run.folder(f'store-{number}')
    daemon = run.start(folder=folder)
    client = daemon.client()
    for mesh in MESHES:
        client.send('PUT', f'/v1/meshes/{mesh}', {'shape': 'cube'})
    path = run.folder('trace')
    with traced(daemon, path):
        traffic = Traffic(daemon, run.chance)
        traffic.run(60)
    run.judge('it stops', daemon.stop() == 0, daemon.log())
    trace = Trace(path)
    verdict = Verdict(run, traffic, trace, 0)
    for kind, count in verdict.checked.items():
        run.count(f'answers of kind {kind}', count)
    run.count('syncs', len(trace.syncs))
    run.judge('no answer was early', not verdict.early,
              f'{len(verdict.early)} were: {verdict.early[:5]}')
    # Checks that the test would notice early answers: if each change is taken to be durable only
    # one sync later than it is, many answers must count as early.
    run.count('seen as early with the next sync', len(Verdict(run, traffic, trace, 1).early))
    os.remove(path)


def prove(run):
    for number in range(run.rounds):
        trace_round(run, number)
        trace_tls_round(run, number)
    run.expect_fired('syncs', 'seen as early with the next sync', 'answers over TLS',
                     'seen as early over TLS with the next sync',
                     *(f'answers of kind {kind}' for kind in (
                         'edit', 'list', 'rename', 'create', 'delete', 'read', 'page of meshes',
                         '404', 'job', 'event')))
