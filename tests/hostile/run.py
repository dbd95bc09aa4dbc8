"""run.py - attacks a daemon, and reports how long each request may hold a thread of the daemon, and
how long it did.

    python3 tests/hostile/run.py --hedged build/hedged [--quick] [--parts rows,starving] [--only TEXT]
                                 [--seed N]

The parts are listed in PARTS below; `cancelling` abandons the requests that were slow in `rows`,
which must run before it.

No request of less than a megabyte may hold the worker for more than 50 ms or, unless it is answered
as a job, a thread of the pool for more than a second. Cancelled work must end within 0.1 s, and
while attacks are begun and abandoned, an import must find a thread. Files of a million faces, which
are sent at once, have a limit of their own in the table, as the manual says. These figures are
processor time (daemon.py), multiplied by how much longer this machine, or a sanitizer, takes for a
known import and check than the machine on which the limits were chosen. An import may wait for no
more than a second of all other work, on any number of cores. The last line is `N passed, N failed`.
"""
import argparse
import json
import os
import random
import re
import sys
import threading

import attacks
import meshes
from daemon import POOL, Connection, Daemon, Hold

MESH = '/v1/meshes/hostile'
MILLION = 1000 * 1000  # nanoseconds of a millisecond

WORKER, THREAD, CANCELLED = 50, 1000, 100  # milliseconds
CLOSED = 1000                              # more of them if the client only closed its side
PLENTY = 5         # times the limit, after which a request is cut off so that the rest gets its turn
REFERENCE = 6.0    # milliseconds that `calibrate` takes with a release build on an idle EPYC
PARTS = ('rows', 'operations', 'corpus', 'cancelling', 'starving')


def state_of(reply):
    """Returns the state of a job, whose result may be longer than what is kept of an answer."""
    return re.search(rb'"state": ?"(\w+)"', reply.body).group(1).decode()


class Tally:
    def __init__(self):
        self.passed, self.failed, self.names = 0, 0, []

    def add(self, name, size, status, worker, pool, limit, good, why=''):
        self.passed += good
        self.failed += not good
        if not good:
            self.names.append(name)
        print(f'{name[:66]:66} {size:7} {status:>6} {worker:9.1f} {pool:9.1f} {limit:>12} '
              f'{"ok" if good else "FAILED " + why}', flush=True)


class Cut(Exception):
    pass


class Field:
    """A daemon, the limits on this machine, and the table that is printed."""

    def __init__(self, options):
        self.options, self.tally = options, Tally()
        self.daemon = Daemon(options.hedged)
        self.scale = 1.0
        self.slow = []  # slow requests, which `cancelling` abandons: (row, ask)

    def is_wanted(self, name):
        return not self.options.only or self.options.only in name

    def calibrate(self):
        """Returns the processor time of an import and a check of 20,000 quads, the least of five.
        """
        body = b'{"shape":"torus","major_segments":200,"minor_segments":100}'
        best = None
        for _ in range(5):
            before = sum(self.daemon.spent(POOL).values())
            for method, path, text in (('PUT', '', body), ('GET', '/check', b'')):
                reply = self.daemon.send(method, MESH + path, text,
                                         ['Content-Type: application/json'] if text else ())
                if reply.status not in (200, 201):
                    raise RuntimeError(f'calibration: {reply.status} {reply.body[:300]}')
            spent = (sum(self.daemon.spent(POOL).values()) - before) / MILLION
            best = spent if best is None else min(best, spent)
        self.forget()
        self.scale = max(1.0, best / REFERENCE)
        print(f'a known import and check: {best:.1f} ms, limits are {self.scale:.2f} times theirs')

    def measure(self, method, path, body, headers):
        """Returns a request's reply, None if it was cut off, and for how long it held threads."""
        name = self.daemon.name_request()
        connection = Connection(self.daemon.port)
        reply = None
        with Hold(self.daemon) as hold:
            def impatient():
                if hold.pool_now() > PLENTY * THREAD * self.scale * MILLION:
                    raise Cut
            connection.be_impatient(impatient)
            connection.send(method, path, body, [*headers, 'X-Request-Id: ' + name])
            try:
                reply = connection.read()
                connection.close()
            except Cut:
                connection.reset()
            except ConnectionError:
                connection.close()
            if reply is not None and reply.status == 202:
                hold.pool = hold.pool_now()
            self.daemon.await_end(name)
        return reply, hold

    def judge(self, name, size, reply, hold, statuses, most=None):
        worker, pool = hold.worker / MILLION, hold.pool / MILLION
        job = reply is not None and reply.status == 202
        why = []
        if reply is None:
            why.append('cut off' if self.daemon.alive() else 'the daemon died')
        elif reply.status not in statuses:
            why.append(f'not {"|".join(map(str, statuses))}: {reply.body[:200]!r}')
        if worker > WORKER * self.scale:
            why.append('held the worker')
        most = (most or THREAD) * self.scale
        if pool > most and not job:
            why.append('held a pool thread')
        limit = f'{WORKER * self.scale:.0f}/' + ('job' if job else f'{most:.0f}')
        self.tally.add(name, size, reply.status if reply else '-', worker, pool, limit, not why,
                       ', '.join(why))
        return not why

    def ask(self, row, ask):
        reply, hold = self.measure(ask.method, MESH + ask.path, ask.body, ask.headers)
        self.judge(f'{row}: {ask.name}', len(ask.body), reply, hold, ask.statuses, ask.most)
        if reply is not None and reply.status == 202:
            self.end_job(f'{row}: {ask.name}', reply)
        elif hold.pool / MILLION > 2 * CANCELLED * self.scale:
            self.slow.append((row, ask))
        return reply

    def end_job(self, name, reply):
        """Lets a job run for a while; a job that goes on is cancelled, which is measured as a row
        of its own."""
        path = reply.headers['location']
        begun = sum(self.daemon.spent(POOL).values())
        while True:
            if state_of(self.daemon.send('GET', path)) not in ('queued', 'running'):
                return
            if sum(self.daemon.spent(POOL).values()) - begun > THREAD * self.scale * MILLION:
                break
        before = sum(self.daemon.spent(POOL).values())
        self.daemon.send('DELETE', path)
        while (state := state_of(self.daemon.send('GET', path))) in ('queued', 'running'):
            pass
        self.cancelled(name + ', job cancelled', state, before)

    def cancelled(self, name, status, before, allowed=CANCELLED):
        after = (sum(self.daemon.spent(POOL).values()) - before) / MILLION
        good = after <= allowed * self.scale
        self.tally.add(name, 0, status, 0, after, f'{allowed * self.scale:.0f}', good,
                       'went on')

    def put(self, row):
        kind, body = row.make()
        path = f'{MESH}?{row.query.lstrip("&")}' if row.query else MESH
        reply, hold = self.measure('PUT', path, body, ['Content-Type: ' + kind, *row.headers])
        self.judge(row.name, len(body), reply, hold, row.statuses)
        if reply is not None and reply.status == 202:
            self.end_job(row.name, reply)
        return reply is not None and reply.status in (200, 201, 202)

    def forget(self):
        self.daemon.send('DELETE', MESH)

    def attack(self, row):
        if self.put(row):
            for ask in row.asks:
                self.ask(row.name, ask)
        self.forget()

    # --- each operation ---

    def attack_operations(self, name, file, faces):
        rows = json.loads(self.daemon.send('GET', '/v1/operations').body)['operations']
        kind, body = file
        for ask in attacks.operation_asks(rows, faces):
            if not self.is_wanted(f'{name}: {ask.name}'):
                continue
            self.daemon.send('PUT', MESH, body, ['Content-Type: ' + kind])
            reply = self.ask(name, ask)
            if reply is not None and reply.status == 200:
                self.ask(name, attacks.Ask('undo of ' + ask.name, 'POST', '/undo',
                                           statuses=(200, 409)))
            self.forget()

    # --- cancelling ---

    def cancel(self, row, ask, how, chance):
        """Begins a request that takes long, disconnects at some moment of it, and measures how long
        the work goes on."""
        name = self.daemon.name_request()
        connection = Connection(self.daemon.port)
        threads = self.daemon.spent(POOL)
        connection.send(ask.method, MESH + ask.path, ask.body,
                        [*ask.headers, 'X-Request-Id: ' + name])
        moment = chance.uniform(0.05, 0.3) * THREAD * self.scale * MILLION
        while self.spent_since(threads) < moment and not self.daemon.has_ended(name):
            pass
        before = sum(self.daemon.spent(POOL).values())
        if how == 'RST':
            connection.reset()
        else:
            connection.close_side()
        entry = self.daemon.await_end(name)
        connection.close()
        allowed = CANCELLED if how == 'RST' else CANCELLED + CLOSED
        self.cancelled(f'{row}: {ask.name}, {how}', entry['status'], before, allowed)

    def spent_since(self, before):
        now = self.daemon.spent(POOL)
        return max(now[t] - before[t] for t in now)

    def cancel_slow(self, chance):
        rows = {row.name: row for row in attacks.ROWS}
        last = None
        for row, ask in self.slow:
            if row not in rows:
                continue
            if row != last:
                self.forget()
                self.put(rows[row])
                last = row
            for how in ('RST', 'FIN'):
                self.cancel(row, ask, how, chance)
        self.forget()

    # --- starving ---

    def import_once(self, body):
        """Returns the status of an import, and the time that all threads worked until it was
        answered, in milliseconds."""
        before = sum(self.daemon.spent(None).values())
        reply = self.daemon.send('PUT', '/v1/meshes/honest', body, ['Content-Type: model/obj'])
        return reply.status, (sum(self.daemon.spent(None).values()) - before) / MILLION

    def starve(self, chance):
        """Abandons requests that take very long, one after another, while a legitimate client
        imports a mesh."""
        body = meshes.obj([(i % 100, i // 100, 0) for i in range(20000)],
                          [(i, i + 1, i + 101) for i in range(19000) if i % 100 < 99])[1]
        body = body[:body.rindex(b'\n', 0, 560 * 1000) + 1]
        quiet = min(self.import_once(body)[1] for _ in range(3))
        kind, fan = meshes.needles(5000)
        self.daemon.send('PUT', MESH, fan, ['Content-Type: ' + kind])
        asks = [attacks.CROSSINGS, attacks.CROSS_OFTEN, attacks.RAYS, attacks.CHECK, attacks.STL]
        ending = threading.Event()

        def abandon():
            while not ending.wait(0.01):
                connections = []
                for _ in range(8):
                    ask = chance.choice(asks)
                    connection = Connection(self.daemon.port)
                    connection.send(ask.method, MESH + ask.path, ask.body, ask.headers)
                    connections.append(connection)
                ending.wait(chance.uniform(0, 0.2))
                for connection in connections:
                    if chance.random() < 0.5:
                        connection.reset()
                    else:
                        connection.close()

        attacker = threading.Thread(target=abandon, daemon=True)
        attacker.start()
        worst, statuses = 0, set()
        for _ in range(10 if self.options.quick else 30):
            status, took = self.import_once(body)
            worst = max(worst, took)
            statuses.add(status)
        ending.set()
        attacker.join()
        most = THREAD * self.scale
        self.tally.add(f'imports while reads are abandoned, the worst ({quiet:.0f} ms alone)',
                       len(body), '|'.join(map(str, sorted(statuses))), 0, worst, f'{most:.0f}',
                       worst <= most and statuses <= {200, 201}, 'waited')
        self.forget()

    # --- hostile files of the corpus ---

    def attack_corpus(self, folder):
        for name in sorted(os.listdir(folder)):
            kind = name.rsplit('.', 1)[-1].lower()
            with open(os.path.join(folder, name), 'rb') as file:
                body = file.read()
            if len(body) < meshes.LARGEST and self.is_wanted('corpus: ' + name):
                row = attacks.Row('corpus: ' + name, lambda b=body, k=kind: (
                    'application/octet-stream', b), [attacks.CHECK, attacks.CROSSINGS],
                    (200, 201, 400, 413, 422), query='&format=' + kind)
                self.attack(row)


def attack_all(field, chance):
    options = field.options
    field.calibrate()
    print(f'{"attack":66} {"bytes":>7} {"status":>6} {"worker ms":>9} {"pool ms":>9} '
          f'{"limit":>12} verdict')
    if 'rows' in options.parts:
        for row in attacks.ROWS:
            if (row.quick or not options.quick) and field.is_wanted(row.name):
                field.attack(row)
    if 'operations' in options.parts and not options.quick:
        field.attack_operations('fan of 60,000', meshes.fan(60000), 60000)
        field.attack_operations('bipyramid of 50,000', meshes.bipyramid(25000), 50000)
    if 'corpus' in options.parts and not options.quick and options.corpus:
        if os.path.isdir(options.corpus):
            field.attack_corpus(options.corpus)
    if 'cancelling' in options.parts:
        field.cancel_slow(chance)
    if 'starving' in options.parts and field.is_wanted('starve'):
        field.starve(chance)


def parts_of(text):
    parts = text.split(',')
    unknown = [part for part in parts if part not in PARTS]
    if unknown:
        raise argparse.ArgumentTypeError(f'no part is called {unknown[0]!r}: {", ".join(PARTS)}')
    if 'cancelling' in parts and 'rows' not in parts:
        raise argparse.ArgumentTypeError('cancelling needs rows, which tell what is slow')
    return parts


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--hedged', required=True)
    parser.add_argument('--quick', action='store_true')
    parser.add_argument('--parts', type=parts_of, default=PARTS, help=f'of {",".join(PARTS)}')
    parser.add_argument('--only', help='rows whose name has this text, and "starve" for the last')
    parser.add_argument('--corpus')
    parser.add_argument('--seed', type=int, default=int(os.environ.get('SEED', '13')))
    options = parser.parse_args()
    print(f'SEED={options.seed}')
    field = Field(options)
    try:
        attack_all(field, random.Random(options.seed))
    finally:
        status = field.daemon.stop()
    field.tally.add('the daemon, stopped', 0, status, 0, 0, '', status == 0, 'broken')
    for name in field.tally.names:
        print('failed:', name)
    print(f'{field.tally.passed} passed, {field.tally.failed} failed')
    return 1 if field.tally.failed or not field.tally.passed else 0


sys.exit(main())
