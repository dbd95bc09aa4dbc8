"""kill.py - kill -9 at any moment (D2, D9): while clients write, while a snapshot is written, while
meshes are loaded, while the daemon starts.

After each kill the daemon is started again and every mesh is compared with the replay. The next
round goes on with the same store, so the last state is the result of all rounds.
"""
import os
import random
import sqlite3
import threading
import time

from daemon import Gone, Refused
from replay import Replay, Wrong
from writers import Change, Writer, Draw, write_for

MESHES = ['a', 'b', 'c']
LARGE = 'large'
LARGE_SHAPE = {'shape': 'grid', 'columns': 170, 'rows': 170}
MOST_TRIES = 10
MOST_KEYS = 3  # number of keys per mesh whose requests are sent again after a kill
# The name under which a kill is counted if it came in time, for each moment at which it is aimed.
AIM = {'writing': 'kills while writing', 'snapshot': 'kills in a snapshot',
       'loading': 'kills while loading', 'starting': 'kills while starting'}
LARGE_KINDS = [('put', 2), ('whole_move', 6), ('splits', 4), ('column', 4)]
SPLITS = 4500       # so many edge splits are done on a copy, and their record is longer than a MiB
MANY_ROUNDS = 100   # after so many rounds each of LARGE_KINDS is sure to have been sent


class Mover(Draw):
    """A client that moves all of a mesh, so that snapshots become due, or replaces it by a content
    that is staged; so are its long lists, and its attributes with a value for each edge."""

    def change_splits(self, mesh):
        ops = [{'op': 'edge_split', 'edge': self.chance.randrange(50000), 't': 0.5}
               for _ in range(SPLITS)]
        return Change(mesh, 'POST', '/edits', {'ops': ops}, {'Prefer': 'wait=600'})

    def change_column(self, mesh):
        body = {'type': 'double', 'components': 4, 'value': [self.number() for _ in range(4)]}
        return Change(mesh, 'PUT', '/attributes/edges/stress', body)

    def change_whole_move(self, mesh):
        while True:
            change = self.change_whole(mesh)
            if change.body['op'] == 'transform':
                return change

    def change_put(self, mesh):
        change = super().change_put(mesh)
        change.body = LARGE_SHAPE
        return change


class Kills:
    def __init__(self, run):
        self.run = run
        self.replay = Replay(run.hedged, [])
        self.daemon = None
        self.start_seconds = 0.05
        self.load_seconds = 0.05
        self.incarnations = {}  # all incarnations that were ever seen, by mesh

    def wait(self, seconds):
        threading.Event().wait(seconds)

    # --- moments at which the daemon is killed ---

    def kill_while_writing(self):
        log, writers = write_for(self.daemon.port, MESHES, random.Random(self.run.chance.random()),
                                 f'k{self.run.chance.random()}')
        self.wait(self.run.chance.uniform(0.005, 0.5))
        return log, writers

    def kill_in_snapshot(self):
        """Kills the daemon while clients write and while a snapshot of a large mesh, which another
        client moves, is being written."""
        log, writers = self.kill_while_writing()
        mover = Writer(self.daemon.port, log, [LARGE],
                       Mover(random.Random(self.run.chance.random()), f'm{time.monotonic()}'),
                       kinds=LARGE_KINDS)
        mover.start()
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline and mover.is_alive() and not self.staged():
            self.wait(0.001)
        self.wait(self.run.chance.uniform(0, 0.03))
        return log, writers + [mover]

    def staged(self):
        """Returns the number of contents that are stored in part and belong to no mesh yet."""
        path = os.path.join(self.run.folder(), 'hedge.db')
        connection = sqlite3.connect(f'file:{path}?mode=ro', uri=True)
        try:
            return connection.execute('SELECT count(*) FROM snapshot WHERE mesh = 0').fetchone()[0]
        except sqlite3.OperationalError:  # the database is busy
            return 0
        finally:
            connection.close()

    def kill_while_loading(self):
        """A daemon that was just started gets requests for all meshes at once, and is killed."""
        self.restart_after(self.kill_while_writing, 'writing')
        self.daemon.kill()
        self.start()
        readers = [threading.Thread(target=self.read, args=(mesh,)) for mesh in [LARGE, *MESHES]]
        self.unanswered = 0
        for reader in readers:
            reader.start()
        self.wait(self.run.chance.uniform(0, self.load_seconds))
        self.daemon.kill()
        for reader in readers:
            reader.join()
        self.run.count('kills while loading', self.unanswered > 0)
        self.start()
        self.compare([], [])

    def read(self, mesh):
        client = self.daemon.client()
        try:
            client.get(f'/v1/meshes/{mesh}')
        except (Gone, OSError):
            self.unanswered += 1
        client.close()

    def kill_while_starting(self):
        self.restart_after(self.kill_while_writing, 'writing', again=False)
        for _ in range(3):  # a recovery may be killed, too, and be followed by another one
            def kill_soon(process):
                threading.Timer(self.run.chance.uniform(0, self.start_seconds),
                                process.kill).start()
            try:
                daemon = self.run.start(on_start=kill_soon)
                daemon.wait()
                self.run.count('kills while starting', 0)
            except Refused as refused:
                self.run.judge('it was killed and did not refuse', refused.status < 0, refused)
                self.run.count('kills while starting')
        self.start()
        self.compare(*self.pending)

    def kill_in_writing(self):
        self.restart_after(self.kill_while_writing, 'writing')

    def kill_in_moving(self):
        self.restart_after(self.kill_in_snapshot, 'moving a large mesh')

    # --- checks after a kill ---

    def start(self):
        begun = time.monotonic()
        self.daemon = self.run.start()
        self.start_seconds = time.monotonic() - begun

    def restart_after(self, moment, name, again=True):
        log, writers = moment()
        killed = self.daemon.kill()
        staged = moment == self.kill_in_snapshot and self.staged()
        for writer in writers:
            writer.stop()
        done, flying = log.take()
        self.run.judge('nothing strange', not log.strange, log.strange[:3])
        self.run.count(f'kills while {name}', killed)
        self.run.count('kills in a snapshot', bool(staged))
        self.run.count('changes', len(done))
        for change in done:
            self.run.count('of kind ' + change.kind)
        for change in [*done, *flying]:
            if change.mesh == LARGE:
                self.run.count(f'sent to {LARGE} of kind {change.kind}')
        self.run.count('in flight', len(flying))
        self.pending = done, flying
        if again:
            self.start()
            self.compare(done, flying)

    def compare(self, done, flying):
        client = self.daemon.client()
        begun = time.monotonic()
        client.get(f'/v1/meshes/{LARGE}')
        self.load_seconds = time.monotonic() - begun
        for mesh in [*MESHES, LARGE]:
            before = self.replay.known[mesh].incarnation if mesh in self.replay.known else None
            made = self.run.attempt(f'{mesh} is what was acknowledged', self.follow, client, mesh,
                                    done, flying)
            if made is None:
                raise Wrong(f'{mesh} cannot be followed further; {self.run.work} has it')
            after = self.replay.known[mesh].incarnation
            if after != before and after is not None:
                self.run.judge('an incarnation is new', after not in self.incarnations, after)
                self.incarnations[after] = mesh
            self.send_again(client, [c for c in done if c.mesh == mesh and c.key and c.version
                                     and c.version[0] == after][-MOST_KEYS:])
        for mesh in MESHES:
            if self.run.chance.random() < 0.25:
                steps = self.run.attempt(f'{mesh}: undo and redo', self.replay.walk, client, mesh)
                self.run.count('steps walked', steps or 0)
        client.close()

    def send_again(self, client, changes):
        """A request that was answered must not be executed twice, also by the daemon that is
        started afterwards."""
        for change in changes:
            answer = change.send(client)
            self.run.count('requests sent again')
            self.run.judge('a key is known after the kill',
                           answer.headers['Idempotency-Replayed'] == 'true'
                           and answer.version() == change.version,
                           f'{change!r}: {answer.status} {answer.headers["ETag"]} {answer.body[:200]}')

    def follow(self, client, mesh, done, flying):
        self.replay.follow(client, mesh, done, flying)
        return True


def prove(run):
    kills = Kills(run)
    kills.start()
    client = kills.daemon.client()
    client.send('PUT', f'/v1/meshes/{LARGE}?name=large', LARGE_SHAPE)
    first = Draw(run.chance, 'first').change_put(LARGE)
    first.body, first.name, first.path = LARGE_SHAPE, 'large', '?name=large'
    kills.replay.follow(client, LARGE, [], [first])
    client.close()
    plan = ['writing'] * run.rounds + ['snapshot'] * (run.rounds // 4)
    plan += ['loading'] * (run.rounds // 4) + ['starting'] * (run.rounds // 10)
    run.chance.shuffle(plan)
    moments = {'writing': kills.kill_in_writing, 'snapshot': kills.kill_in_moving,
               'loading': kills.kill_while_loading, 'starting': kills.kill_while_starting}
    for moment in plan:
        before = dict(run.counts)
        for _ in range(MOST_TRIES):  # repeated until the kill came in time
            moments[moment]()
            if run.counts[AIM[moment]] > before.get(AIM[moment], 0):
                break
    run.count('changes made again', kills.replay.applied)
    run.count('in flight and there', kills.replay.in_flight)
    run.judge('it stops', kills.daemon.stop() == 0, kills.daemon.log())
    kills.replay.close()
    run.expect_fired('in flight', 'requests sent again',
                     *('of kind ' + kind for kind, _ in Draw.KINDS),
                     *(f'sent to {LARGE} of kind {kind}' for kind, _ in LARGE_KINDS
                       if run.rounds >= MANY_ROUNDS),
                     *(AIM[moment] for moment in sorted(set(plan))))
