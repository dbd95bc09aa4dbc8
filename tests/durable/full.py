"""full.py - a disk becomes full while four clients write, and is emptied by DELETE alone (D5).

The store lies on a file system of 32 MiB in memory. Meshes are made until there is no space: then
the answer must be 507, nothing may be half done, and reads must go on. Then the meshes are deleted,
one after another, until writes work again, without a restart. Everything that was acknowledged must
be there, before and after a restart.
"""
import os
import random
import socket
import subprocess
import sys
import threading
import time

from faulty import DISK_CODES, Patient
from replay import Replay
from writers import Draw, Log

MESHES = ['a', 'b', 'c']
SIZE = '32m'
FILL = {'shape': 'grid', 'columns': 90, 'rows': 90}
PATIENCE = 60  # seconds in which writes must work again


def in_own_mounts():
    """Moves this process into mounts of its own, which only it and its children see, and which end
    with it."""
    if 'DURABLE_MOUNTS' in os.environ:
        return
    os.environ['DURABLE_MOUNTS'] = '1'
    who = [] if os.geteuid() == 0 else ['--map-root-user']
    os.execvp('unshare', ['unshare', '--mount', *who, sys.executable, '-B', *sys.argv])


class Stubborn(Patient):
    """A client that goes on however often the disk was full."""

    def refuse(self, change, answer):
        self.refusals = 0
        super().refuse(change, answer)


class Systemd:
    """The receiving end of NOTIFY_SOCKET, in the place of systemd."""

    def __init__(self):
        name = f'hedge-full-{os.getpid()}'
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind('\0' + name)
        self.heard = []
        os.environ['NOTIFY_SOCKET'] = '@' + name
        threading.Thread(target=self.hear, daemon=True).start()

    def hear(self):
        while True:
            self.heard.append(self.socket.recv(4096).decode())

    def statuses(self):
        """Returns the statuses that `systemctl status` would have shown, in order."""
        return [line[7:] for text in list(self.heard) for line in text.splitlines()
                if line.startswith('STATUS=')]


def shows_in_turn(statuses, port):
    """Returns whether the daemon of the port was shown as listening, then with a full disk, then
    without, and so on, and whether the last status is that a daemon stops. The daemon in memory
    that replays all changes sends its statuses to the same socket."""
    told = [more for what, _, more in (status.partition('; ') for status in statuses)
            if what == f'listening on http://127.0.0.1:{port}']
    return len(told) % 2 == 1 and len(told) > 2 and statuses[-1] == 'stopping' and all(
        more == ('the disk is full, and changes are refused' if i % 2 else '')
        for i, more in enumerate(told))


def fill(run, client):
    """Makes meshes until there is no space; returns their names."""
    made = []
    while True:
        name = f'fill{len(made)}'
        answer = client.send('PUT', f'/v1/meshes/{name}', FILL)
        if answer.code() in DISK_CODES:
            run.judge('PUT says that the disk is full', answer.code() == 'store_full', answer.body)
            run.count('times full')
            return made
        if not run.judge('a mesh is made', answer.status == 201, answer.body):
            return made
        made.append(name)


def empty(run, client, log, made):
    """Deletes meshes until something could be written again."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        before = len(log.done)
        if made:
            answer = client.send('DELETE', '/v1/meshes/' + made.pop())
            run.count('deleted', answer.status == 204)
            run.judge('DELETE works', answer.status == 204, answer.body)
        threading.Event().wait(0.5)
        if len(log.done) > before + 20:
            return True
    return False


def has_space(run, client, made):
    """Deletes the remaining meshes until the store is writable; returns false if that takes too
    long."""
    deadline = time.monotonic() + PATIENCE
    while client.get('/readyz').json().get('store') != 'writable':
        if time.monotonic() > deadline:
            return False
        if made:
            client.send('DELETE', '/v1/meshes/' + made.pop())
        threading.Event().wait(0.2)
    return True


def says_in_turn(log, folder):
    """Returns whether the log says in turn that the disk of the folder is full and that it has
    space again."""
    told = [line for line in log.splitlines() if f'the disk of {folder} ' in line]
    return told and all(('is full' if i % 2 == 0 else 'has space') in line
                        for i, line in enumerate(told))


def follow_all(run, client, replay, done, flying, when):
    for mesh in MESHES:
        run.attempt(f'{mesh} is what was acknowledged, {when}', replay.follow, client, mesh, done,
                    flying)


def prove(run):
    in_own_mounts()
    folder = run.folder()
    systemd = Systemd()
    for _ in range(run.rounds):
        os.makedirs(folder, exist_ok=True)
        subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=' + SIZE, 'tmpfs', folder], check=True)
        daemon, log, replay = run.start(), Log(), Replay(run.hedged, [])
        writers = [Stubborn(daemon.port, log, MESHES, Draw(random.Random(run.chance.random()),
                                                           f'w{i}')) for i in range(4)]
        for writer in writers:
            writer.start()
        client = daemon.client()
        made = fill(run, client)
        threading.Event().wait(1)
        for mesh in MESHES:
            run.judge('reads go on', client.get(f'/v1/meshes/{mesh}').status in (200, 404))
        ready = client.get('/readyz')
        run.judge('it says that the disk is full', ready.status == 200 and
                  ready.json().get('store') == 'full', ready.body)
        run.judge('writes work again', empty(run, client, log, made), daemon.log())
        for writer in writers:
            writer.stop()
        run.judge('it says that there is space', has_space(run, client, made), daemon.log())
        done, flying = log.take()
        run.count('changes', len(done))
        run.count('changes refused', log.refused.get('store_full', 0))
        run.judge('nothing strange', not log.strange, log.strange[:2])
        follow_all(run, client, replay, done, flying, 'without a restart')
        client.close()
        run.judge('it stops', daemon.stop() == 0, daemon.log())
        run.judge('the log tells of it', says_in_turn(daemon.log(), folder), daemon.log())
        run.judge('systemd is told of it', shows_in_turn(systemd.statuses(), daemon.port),
                  systemd.statuses())
        systemd.heard.clear()
        daemon = run.start()
        client = daemon.client()
        follow_all(run, client, replay, [], [], 'after a restart')
        client.close()
        run.judge('it stops', daemon.stop() == 0, daemon.log())
        systemd.heard.clear()
        replay.close()
        subprocess.run(['umount', folder], check=True)
    run.expect_fired('times full', 'changes refused', 'deleted')
