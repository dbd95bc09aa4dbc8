"""daemon.py - a daemon that can be killed and started again, and clients for it."""
import atexit
import http.client
import json
import os
import re
import signal
import subprocess
import threading

PATIENCE = 120  # seconds until an answer that does not come ends the run
ETAG = re.compile(r'"([0-9a-f]+)-(\d+)-(\d+)')


class Gone(Exception):
    """Raised if the daemon ended, or closed the connection, before it answered."""


class Answer:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    def json(self):
        return json.loads(self.body)

    def version(self):
        """Returns the incarnation, metadata counter and revision in the entity tag; None if there
        is no tag."""
        found = ETAG.match(self.headers.get('ETag') or '')
        return found and (found[1], int(found[2]), int(found[3]))

    def code(self):
        return self.json().get('code') if self.body.startswith(b'{') else None


class Client:
    """One connection, which only one thread may use."""

    def __init__(self, port, patience=PATIENCE):
        self.connection = http.client.HTTPConnection('127.0.0.1', port, timeout=patience)

    def send(self, method, path, body=None, headers=None):
        headers = dict(headers or {})
        if isinstance(body, (dict, list)):
            body = json.dumps(body).encode()
            headers.setdefault('Content-Type', 'application/json')
        try:
            self.connection.request(method, path, body, headers)
            reply = self.connection.getresponse()
            return Answer(reply.status, reply.headers, reply.read())
        except (OSError, http.client.HTTPException) as error:
            self.connection.close()
            if isinstance(error, TimeoutError):
                raise
            raise Gone(str(error)) from error

    def get(self, path, accept=None):
        return self.send('GET', path, headers={'Accept': accept} if accept else None)

    def close(self):
        self.connection.close()


class Refused(Exception):
    """Raised if the daemon ended before it listened; the text is its output."""

    def __init__(self, status, said):
        super().__init__(f'exit status {status}: {said.strip()}')
        self.status, self.said = status, said


def environment(faults, library):
    """Returns the environment of a daemon; `faults` are the settings of inject/faults.c, or None."""
    variables = dict(os.environ)
    if faults is not None:
        variables.update({name: str(value) for name, value in faults.items()})
        variables['LD_PRELOAD'] = library
        # A sanitizer requires to be the first library; this option makes it accept another one
        # before it.
        variables['ASAN_OPTIONS'] = (variables.get('ASAN_OPTIONS', '')
                                     + ':verify_asan_link_order=0')
    return variables


class Daemon:
    """A daemon on a free port. `faults` are the settings of inject/faults.c, `around` is a program
    to run it under."""

    def __init__(self, program, flags, faults=None, library=None, around=(), on_start=None):
        self.process = subprocess.Popen(
            [*around, program, '--listen', '127.0.0.1:0', '--log', 'off', '--idle-timeout', '3600',
             *flags],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
            env=environment(faults, library))
        atexit.register(self.process.kill)  # no effect on one that was waited for
        if on_start:
            on_start(self.process)
        self.said = []
        for line in self.process.stderr:
            self.said.append(line)
            if 'listening on ' in line:
                self.port = int(line.rsplit(':', 1)[1])
                break
        else:
            self.process.stderr.close()
            raise Refused(self.process.wait(), ''.join(self.said))
        self.reader = threading.Thread(target=self.read_log, daemon=True)
        self.reader.start()

    def read_log(self):
        for line in self.process.stderr:
            self.said.append(line)

    def log(self):
        return ''.join(self.said)

    def client(self, patience=PATIENCE):
        return Client(self.port, patience)

    def is_alive(self):
        return self.process.poll() is None

    def wait(self):
        status = self.process.wait(PATIENCE)
        atexit.unregister(self.process.kill)
        self.reader.join()
        self.process.stderr.close()
        return status

    def kill(self):
        """Kills the daemon as the system would when it is out of memory. Returns true if it was
        still running."""
        self.process.send_signal(signal.SIGKILL)
        return self.wait() == -signal.SIGKILL

    def stop(self):
        self.process.terminate()
        return self.wait()

    def memory(self):
        """Returns the bytes that are resident now, and the maximum so far."""
        with open(f'/proc/{self.process.pid}/status', encoding='ascii') as file:
            text = file.read()
        return tuple(int(re.search(name + r':\s+(\d+) kB', text)[1]) * 1024
                     for name in ('VmRSS', 'VmHWM'))
