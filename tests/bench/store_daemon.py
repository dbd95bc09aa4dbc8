"""store_daemon.py - what a durable store costs the clients of the daemon: rows in addition to those
of tests/bench/store.c.

    python3 tests/bench/store_daemon.py --hedged build/hedged --work FOLDER [--rounds N] [--side N]
        [--only ROW...]

FOLDER is on the disk to be measured. The large meshes have SIDE x SIDE quads, by default a million.
The time of an edit is that from the request to the durable answer, for one client over one
connection.
"""
import argparse
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'durable'))
from daemon import Daemon  # pylint: disable=wrong-import-position

EDITS = 10000        # edits that the daemon applies again when it starts
SAMPLES = 500        # edits in a round without snapshots
ABOVE_QUIET = 0.010  # seconds that the 99th percentile may rise
FIRST_ANSWER = 5     # seconds; the longest that is allowed
BASE_SECONDS = 5     # seconds in which a base is surely written
WAL = 256 << 20      # bytes; the largest write-ahead log that is allowed
READS = 0.9          # least rate of reads, as a share of that with the store in memory
LOADED = 6           # large meshes that take turns in memory
LOAD_BUDGET = 512 << 20
LOAD_SECONDS = 20
# This edit makes a record as large as the content of its mesh: after the second one, a new base (a
# record with the whole content) is due.
MOVE = {'op': 'transform', 'matrix': [1, 0, 0, .1, 0, 1, 0, .1, 0, 0, 1, .1, 0, 0, 0, 1]}
PATIENTLY = {'Prefer': 'wait=600'}


class Bench:
    def __init__(self, options):
        self.hedged, self.rounds, self.side = options.hedged, options.rounds, options.side
        os.makedirs(options.work, exist_ok=True)
        self.work = os.path.realpath(tempfile.mkdtemp(prefix='bench-', dir=options.work))
        self.met = True

    def start(self, name, *flags):
        return Daemon(self.hedged, ['--store', 'sqlite:' + os.path.join(self.work, name), *flags])

    def end(self, daemon, name):
        expect(daemon.stop(), 0, daemon.log())
        shutil.rmtree(os.path.join(self.work, name))

    def make(self, client, name):
        answer = client.send('PUT', '/v1/meshes/' + name, {
            'shape': 'torus', 'major_segments': self.side, 'minor_segments': self.side}, PATIENTLY)
        expect(answer.status, 201, answer.body)

    def tell(self, what, found, aim, good):
        self.met = self.met and good
        print(f'{what:<52} {found:>10}   aim {aim:<9} {"met" if good else "falls short"}', flush=True)


def expect(found, wanted, why):
    if found != wanted:
        sys.exit(f'store_daemon.py: {found}, not {wanted}: {why[:400]!r}')


def edit(client, number):
    """Returns the seconds until the edit is durable."""
    begun = time.perf_counter()
    answer = client.send('POST', '/v1/meshes/small/edits', {
        'op': 'vertex_move', 'vertex': number % 8, 'to': [0, 0, number % 100]})
    expect(answer.status, 200, answer.body)
    return time.perf_counter() - begun


def percentile(times, share):
    return sorted(times)[min(len(times) - 1, int(share * len(times)))]


def edits_while(daemon, work):
    """Returns the times of edits, made one after another as long as work(client) runs."""
    ended = threading.Event()

    def run():
        client = daemon.client()
        work(client)
        client.close()
        ended.set()

    client, times = daemon.client(), []
    thread = threading.Thread(target=run)
    thread.start()
    while not ended.is_set():
        times.append(edit(client, len(times)))
    thread.join()
    client.close()
    return times


def beside_snapshots(bench):
    """An edit must wait little longer while the content of a large mesh is written: when the mesh
    is made, when a new base is due because it has many records, and when all of it is moved, which
    makes one record as large as its content. The edits of a quiet daemon are measured in turn with
    these."""
    quiet, made, moved, rebased = [], [], [], []
    daemon = bench.start('snapshots')
    client = daemon.client()
    expect(client.send('PUT', '/v1/meshes/small', {'shape': 'cube'}).status, 201, '')
    bench.make(client, 'large')

    def move(other):
        for _ in range(2):
            answer = other.send('POST', '/v1/meshes/large/edits', MOVE, PATIENTLY)
            expect(answer.status, 200, answer.body)

    def write_base(_):
        time.sleep(BASE_SECONDS)

    for _ in range(bench.rounds):
        quiet.append(percentile([edit(client, i) for i in range(SAMPLES)], .99))
        made.append(percentile(edits_while(daemon, lambda other: bench.make(other, 'made')), .99))
        expect(client.send('DELETE', '/v1/meshes/made').status, 204, '')
        moved.append(percentile(edits_while(daemon, move), .99))
        # The mesh's base is due by then, and is written after the answer.
        rebased.append(percentile(edits_while(daemon, write_base), .99))
    bench.end(daemon, 'snapshots')
    base = statistics.median(quiet)
    print(f'an edit, nothing beside it: p99 {1000 * base:.1f} ms, median of {bench.rounds} rounds')
    for what, times in (('is made', made), ('gets a new base', rebased), ('is moved', moved)):
        above = statistics.median(times) - base
        bench.tell(f'p99 while a large mesh {what}, above that', f'{1000 * above:.1f} ms',
                   f'{1000 * ABOVE_QUIET:.0f} ms', above <= ABOVE_QUIET)


def first_answer(bench):
    """Measures the time from the start of the program to the first answer about a large mesh with
    many edits, after kill -9 and with nothing of the store in the page cache."""
    daemon = bench.start('start')
    client = daemon.client()
    bench.make(client, 'small')
    for i in range(EDITS):
        edit(client, i)
    times = []
    for _ in range(bench.rounds):
        daemon.kill()
        folder = os.path.join(bench.work, 'start')
        for name in os.listdir(folder):
            file = os.open(os.path.join(folder, name), os.O_RDONLY)
            os.fsync(file)  # what was not written back stays in memory
            os.posix_fadvise(file, 0, 0, os.POSIX_FADV_DONTNEED)
            os.close(file)
        begun = time.perf_counter()
        daemon = bench.start('start')
        answer = daemon.client().get('/v1/meshes/small')
        times.append(time.perf_counter() - begun)
        expect(answer.status, 200, answer.body)
        expect(answer.json()['revision'], EDITS + 1, answer.body)
    bench.end(daemon, 'start')
    found = statistics.median(times)
    bench.tell(f'first answer about it after {EDITS:,} edits and a kill', f'{found:.2f} s',
               f'{FIRST_ANSWER} s', found <= FIRST_ANSWER)


def log_under_loads(bench):
    """Large meshes take turns in memory, so that meshes are loaded all the time, while large
    contents are written."""
    daemon = bench.start('loads', '--memory-budget', str(LOAD_BUDGET))
    client = daemon.client()
    for i in range(LOADED):
        bench.make(client, f'm{i}')
    ending, loads = threading.Event(), [0, 0]

    def load(which):
        mine = daemon.client()
        while not ending.is_set():
            mine.send('GET', f'/v1/meshes/m{(2 * loads[which] + which) % LOADED}/vertices/1')
            loads[which] += 1

    def write():
        mine = daemon.client()
        while not ending.is_set():
            answer = mine.send('PUT', '/v1/meshes/other', {
                'shape': 'torus', 'major_segments': bench.side, 'minor_segments': bench.side // 4})
            if answer.status not in (200, 201, 503, 507):
                sys.exit(f'store_daemon.py: {answer.status} {answer.body[:400]!r}')

    threads = [threading.Thread(target=load, args=(i,)) for i in range(2)]
    threads.append(threading.Thread(target=write))
    for thread in threads:
        thread.start()
    largest = 0
    until = time.monotonic() + LOAD_SECONDS
    while time.monotonic() < until:
        time.sleep(0.01)
        largest = max(largest, os.path.getsize(os.path.join(bench.work, 'loads', 'hedge.db-wal')))
    ending.set()
    for thread in threads:
        thread.join()
    bench.end(daemon, 'loads')
    bench.tell(f'-wal at most, while {sum(loads)} reads loaded meshes', f'{largest >> 20} MiB',
               f'{WAL >> 20} MiB', largest <= WAL)


def reads(bench):
    """A mesh that is in memory must be read at the same rate, whichever journal stores it."""
    rates = {'memory': [], 'sqlite': []}
    for i in range(bench.rounds):
        for kind, of in rates.items():
            store = kind if kind == 'memory' else f'sqlite:{bench.work}/reads{i}'
            daemon = Daemon(bench.hedged, ['--store', store, '--workers', '1'])
            answer = daemon.client().send('PUT', '/v1/meshes/m', {'shape': 'icosphere'})
            expect(answer.status, 201, answer.body)
            said = subprocess.run(['wrk', '-t1', '-c64', '-d2s',
                                   f'http://127.0.0.1:{daemon.port}/v1/meshes/m/faces/3'],
                                  capture_output=True, text=True, check=True).stdout
            expect('Non-2xx' in said, False, said)
            of.append(float(re.search(r'Requests/sec:\s+([\d.]+)', said)[1]))
            expect(daemon.stop(), 0, daemon.log())
    share = statistics.median(rates['sqlite']) / statistics.median(rates['memory'])
    print(f'reads a second: memory {statistics.median(rates["memory"]):.0f}, '
          f'SQLite {statistics.median(rates["sqlite"]):.0f}')
    bench.tell('reads, of those of memory', f'{share:.2f}', f'{READS}', share >= READS)


ROWS = {'snapshots': beside_snapshots, 'start': first_answer, 'log': log_under_loads,
        'reads': reads}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--hedged', required=True)
    parser.add_argument('--work', required=True)
    parser.add_argument('--rounds', type=int, default=3)
    parser.add_argument('--side', type=int, default=1024)
    parser.add_argument('--only', nargs='+', choices=ROWS, default=list(ROWS))
    options = parser.parse_args()
    bench = Bench(options)
    try:
        print(f'large: {bench.side * bench.side:,} faces; medians of {bench.rounds} rounds')
        for name, row in ROWS.items():
            if name in options.only:
                row(bench)
    finally:
        shutil.rmtree(bench.work, ignore_errors=True)


if __name__ == '__main__':
    main()
