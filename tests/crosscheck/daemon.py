"""daemon.py - starts a daemon for the tests of this folder, and sends it requests."""
import http.client
import json
import re
import subprocess
import urllib.parse


class Daemon:
    """A daemon that is started on a free port, and stopped at the end of the `with` block."""

    def __init__(self, program):
        self.process = subprocess.Popen([program, '--listen', '127.0.0.1:0', '--store', 'memory'],
                                        stderr=subprocess.PIPE, text=True)
        line = ''
        while 'listening on ' not in line:
            line = self.process.stderr.readline()
            if line == '':
                raise RuntimeError('the daemon does not start')
        u = urllib.parse.urlsplit(re.search(r'http://\S+', line)[0])
        self.connection = http.client.HTTPConnection(u.hostname, u.port, timeout=600)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.connection.close()
        self.process.terminate()
        _, said = self.process.communicate()
        self.status = self.process.returncode
        if self.status != 0:
            print(said)

    def send(self, method, path, body=None, kind='application/octet-stream'):
        """Returns the status and the bytes of an answer. If the daemon has closed the connection, a
        new one is opened."""
        for again in (True, False):
            try:
                self.connection.request(method, path, body, {'Content-Type': kind})
                r = self.connection.getresponse()
                return r.status, r.read()
            except (BrokenPipeError, ConnectionResetError, http.client.RemoteDisconnected):
                self.connection.close()
                if not again:
                    raise
        return None

    def create(self, kind, body, repair=None):
        path = '/v1/meshes?format=' + kind + ('&repair=' + ','.join(repair) if repair else '')
        status, text = self.send('POST', path, body)
        return status, json.loads(text)

    def delete(self, mesh):
        self.send('DELETE', '/v1/meshes/' + mesh)

    def read(self, kind, body, repair=None):
        """Returns what the daemon says about a file; the mesh is deleted again."""
        status, answer = self.create(kind, body, repair)
        if status == 201:
            self.delete(answer['id'])
        return status, answer
