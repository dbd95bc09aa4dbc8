"""arrays.py - the time in which a program gets the positions of a million vertices as a numpy array,
and writes them back.

    python3 tests/bench/arrays.py ADDRESS [ROUNDS]        ADDRESS of a daemon

Each round reads all positions, moves every vertex and writes all positions, as doubles and as floats,
over one connection. Each reading is of a revision that nobody has read before. Medians are printed.
"""
import http.client
import json
import statistics
import sys
import time

import numpy

OCTETS = 'application/octet-stream'
SIDE = 1000
TARGET = 60  # milliseconds


def send(connection, method, path, body=None, headers=None):
    connection.request(method, path, body, headers or {})
    answer = connection.getresponse()
    content = answer.read()
    if answer.status not in (200, 201, 204):
        sys.exit(f'arrays.py: {method} {path}: {answer.status} {content[:300]!r}')
    return content


def get(connection, path, number):
    content = send(connection, 'GET', path, None, {'Accept': OCTETS, 'Prefer': 'wait=30'})
    return numpy.frombuffer(content, number).reshape(-1, 3)


def timed(action):
    begin = time.perf_counter()
    result = action()
    return 1000 * (time.perf_counter() - begin), result


def measure(connection, path, number, rounds):
    """Returns the milliseconds of each reading and of each writing, without the first round."""
    reads, writes = [], []
    for _ in range(rounds + 1):
        spent, points = timed(lambda: get(connection, path, number))
        reads.append(spent)
        moved = points + number(0.001)
        spent, _ = timed(lambda: send(
            connection, 'PUT', path, memoryview(moved).cast('B'),
            {'Content-Type': OCTETS, 'Prefer': 'return=minimal, wait=30'}))
        writes.append(spent)
        if not numpy.array_equal(get(connection, path, number), moved):
            sys.exit('arrays.py: what is read is not what was written')
        send(connection, 'PUT', path, memoryview(points).cast('B'),
             {'Content-Type': OCTETS, 'Prefer': 'return=minimal, wait=30'})
    return reads[1:], writes[1:]


def main():
    address, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 9
    connection = http.client.HTTPConnection(address.split('//')[-1])
    shape = {'shape': 'torus', 'major_segments': SIDE, 'minor_segments': SIDE}
    send(connection, 'POST', '/v1/meshes?id=arrays', json.dumps(shape),
         {'Content-Type': 'application/json', 'Prefer': 'wait=30'})
    for name, number in (('double', numpy.float64), ('float', numpy.float32)):
        path = f'/v1/meshes/arrays/attributes/vertices/position?type={name}'
        for what, times in zip(('GET', 'PUT'), measure(connection, path, number, rounds)):
            median = statistics.median(times)
            verdict = 'met' if median <= TARGET else 'falls short'
            print(f'{what} {SIDE * SIDE} positions, {name + "s":8} {median:5.0f} ms '
                  f'({min(times):.0f} to {max(times):.0f})   target {TARGET}   {verdict}')
    send(connection, 'DELETE', '/v1/meshes/arrays')


main()
