"""daemon.py - a daemon under attack, and the processor time of its threads meanwhile.

The figures are the system's account of each thread's processor time, so they do not depend on what
else the machine does. The daemon has one worker. A thread of this program requests /livez again and
again, and reads the worker's time at each answer: what the worker did between two answers is the
most that it can have done without serving others, and the longest of these times is how long it was
held. A pool thread is held for the time that it works from the beginning of a request to its end.
"""
import json
import os
import socket
import struct
import subprocess
import tempfile
import threading
import time

WORKERS = ('MHD-worker', 'MHD-single')
POOL = ('hedged-pool', 'hedged-answers', 'hedged-parts')
PATIENCE = 300  # seconds until an answer that does not come ends the run


class Reply:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    def json(self):
        return json.loads(self.body)


class Connection:
    """A socket on which requests are sent and their answers read, one after another."""

    def __init__(self, port):
        self.socket = socket.create_connection(('127.0.0.1', port), timeout=PATIENCE)
        self.impatient = None
        self.most_kept = 1 << 12  # bytes of an answer, roughly; the rest is dropped
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.rest = b''

    def send(self, method, path, body=b'', headers=()):
        head = [f'{method} {path} HTTP/1.1', 'Host: localhost', *headers]
        if body or method in ('POST', 'PUT', 'PATCH'):
            head.append(f'Content-Length: {len(body)}')
        self.socket.settimeout(PATIENCE)
        try:
            self.socket.sendall(('\r\n'.join(head) + '\r\n\r\n').encode() + body)
        except (BrokenPipeError, ConnectionResetError):
            pass  # the daemon answered before it had read the whole request
        if self.impatient is not None:
            self.socket.settimeout(0.25)

    def be_impatient(self, ask):
        """While an answer is awaited, calls ask() four times a second; an exception in it ends the
        wait."""
        self.socket.settimeout(0.25)
        self.impatient = ask

    def more(self):
        while True:
            try:
                got = self.socket.recv(1 << 16)
                break
            except TimeoutError:
                if self.impatient is None:
                    raise
                self.impatient()
        self.rest += got
        return len(got) > 0

    def line(self):
        while b'\r\n' not in self.rest:
            if not self.more():
                raise ConnectionError('no answer')
        line, self.rest = self.rest.split(b'\r\n', 1)
        return line.decode('latin-1')

    def skip(self, count, kept):
        """Reads `count` bytes; the first of them are appended to `kept`."""
        while count > 0:
            if not self.rest and not self.more():
                raise ConnectionError('cut off')
            part, self.rest = self.rest[:count], self.rest[count:]
            if len(kept) < self.most_kept:
                kept += part
            count -= len(part)

    def read(self):
        status, headers, body = int(self.line().split()[1]), {}, bytearray()
        while (line := self.line()) != '':
            name, value = line.split(':', 1)
            headers[name.lower()] = value.strip()
        if headers.get('transfer-encoding') == 'chunked':
            while (size := int(self.line(), 16)) > 0:
                self.skip(size, body)
                self.line()
            self.line()
        elif status != 204 and status != 304:
            self.skip(int(headers.get('content-length', 0)), body)
        return Reply(status, headers, bytes(body))

    def close_side(self):
        try:
            self.socket.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # the daemon answered and closed the connection meanwhile

    def reset(self):
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        self.socket.close()

    def close(self):
        self.socket.close()


PROBE = 0.002  # seconds between two requests of /livez


class Prober(threading.Thread):
    """Requests /livez until it is stopped; `most` is the longest time for which the worker was
    held, in ns."""

    def __init__(self, daemon):
        super().__init__(daemon=True)
        self.target, self.most, self.ending = daemon, 0, threading.Event()
        self.connection = Connection(daemon.port)
        self.ask()

    def ask(self):
        self.connection.send('GET', '/livez')
        self.connection.read()
        self.seen = self.target.spent(WORKERS)

    def run(self):
        while True:
            slept = time.monotonic()
            if self.ending.wait(PROBE):
                return
            # If this thread is woken late on a busy machine, it does not count what the worker did
            # in the meantime, because that has delayed no request.
            late = time.monotonic() - slept > 5 * PROBE
            before = self.target.spent(WORKERS) if late else self.seen
            self.ask()
            self.most = max(self.most, max(self.seen[t] - before.get(t, 0) for t in self.seen))

    def stop(self):
        self.ending.set()
        self.join()
        self.connection.close()


class Hold:
    """What the threads did while the block ran: the longest time that the worker was held, and the
    time of a pool thread, in ns."""

    def __init__(self, daemon):
        self.daemon, self.worker, self.pool = daemon, 0, 0

    def __enter__(self):
        self.prober = Prober(self.daemon)
        self.before = self.daemon.spent(POOL)
        self.prober.start()
        return self

    def pool_now(self):
        now = self.daemon.spent(POOL)
        return max(now[t] - self.before.get(t, 0) for t in now)

    def __exit__(self, *_):
        self.prober.stop()
        self.worker, self.pool = self.prober.most, self.pool_now()


class Daemon:
    def __init__(self, program, *flags):
        self.log = tempfile.TemporaryFile('w+')
        self.process = subprocess.Popen(
            [program, '--listen', '127.0.0.1:0', '--store', 'memory', '--workers', '1', '--jobs', '2',
             '--log', 'access', *flags], stderr=subprocess.PIPE, text=True)
        self.ended = {}  # lines of the access log by the request's id
        self.ending = threading.Condition()
        line = self.process.stderr.readline()
        while line and 'listening on ' not in line:
            line = self.process.stderr.readline()
        if not line:
            raise RuntimeError('the daemon does not start')
        self.port = int(line.rsplit(':', 1)[1])
        self.reader = threading.Thread(target=self.read_log, daemon=True)
        self.reader.start()
        self.number = 0
        self.send('GET', '/livez')  # by now its threads have their names
        tasks = f'/proc/{self.process.pid}/task'
        self.threads = [(t, open(f'{tasks}/{t}/comm').read().strip()) for t in os.listdir(tasks)]
        if not self.spent(WORKERS) or not self.spent(POOL):
            raise RuntimeError(f'threads without names: {self.threads}')

    def read_log(self):
        for line in self.process.stderr:
            if not line.startswith('{'):
                print(line, end='')
                continue
            entry = json.loads(line)
            if entry.get('path') != '/livez':
                with self.ending:
                    self.ended[entry.get('request_id')] = entry
                    self.ending.notify_all()

    def has_ended(self, name):
        with self.ending:
            return name in self.ended

    def await_end(self, name):
        """Waits until the work for the request has ended and nothing of it runs any more."""
        with self.ending:
            if not self.ending.wait_for(lambda: name in self.ended, PATIENCE):
                raise RuntimeError(f'{name} does not end')
            return self.ended.pop(name)

    def spent(self, names):
        """Returns the nanoseconds of processor time of each thread that has one of these names;
        None means all threads."""
        out = {}
        for thread, name in self.threads:
            if names is None or name in names:
                with open(f'/proc/{self.process.pid}/task/{thread}/schedstat') as file:
                    out[thread] = int(file.read().split()[0])
        return out

    def name_request(self):
        self.number += 1
        return f'hostile-{self.number}'

    def send(self, method, path, body=b'', headers=()):
        connection = Connection(self.port)
        connection.most_kept = 1 << 30
        connection.send(method, path, body, headers)
        try:
            return connection.read()
        finally:
            connection.close()

    def alive(self):
        return self.process.poll() is None

    def stop(self):
        self.process.terminate()
        return self.process.wait()
