"""peers.py - other programs read files of the daemon, and the daemon reads theirs.

Each mesh is exported in every format and encoding. assimp, OpenMesh, CGAL and the reference reader
of the corpus must find the faces, edges and vertices that it has; what OpenMesh, CGAL and assimp
write of it must become the same mesh again. Known differences are not compared: OpenMesh and CGAL
read no GLB; assimp makes a vertex of every corner, so its files are welded and only their faces
compared; and each program cuts polygons into triangles in its own way for STL.
"""
import math
import os
import re
import subprocess

EXPORTS = [('obj', ''), ('off', ''), ('ply', ''), ('ply', 'ascii'), ('ply', 'binary_big_endian'),
           ('stl', ''), ('stl', 'ascii'), ('glb', '')]


def torus(n, m):
    v, f = [], []
    for i in range(n):
        for k in range(m):
            a, b = 2 * math.pi * i / n, 2 * math.pi * k / m
            x = 2 + math.cos(b)
            v.append((x * math.cos(a), x * math.sin(a), math.sin(b)))
    for i in range(n):
        for k in range(m):
            p, q = (i + 1) % n, (k + 1) % m
            f.append((i * m + k, p * m + k, p * m + q, i * m + q))
    return v, f


def shapes():
    t = ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    v, f = torus(7, 5)
    triangles = [x for a, b, c, d in f for x in ((a, b, c), (a, c, d))]
    ring = [(math.cos(i), math.sin(i), 0.0) for i in range(6)]
    fan = ring + [(2 * x, 2 * y, 1.0) for x, y, _ in ring]
    walls = [(i, i + 1, i + 7, i + 6) for i in range(5)] + [tuple(range(5, -1, -1))]
    return {'tetrahedron': t, 'torus': (v, f), 'triangles': (v, triangles),
            'open': (v, triangles[:-3]), 'polygons': (fan, walls)}


def as_off(v, f):
    lines = ['OFF', '%d %d 0' % (len(v), len(f))]
    lines += [' '.join(map(repr, p)) for p in v]
    lines += ['%d %s' % (len(x), ' '.join(map(str, x))) for x in f]
    return '\n'.join(lines).encode()


class Tally:
    def __init__(self):
        self.passed = self.failed = 0

    def check(self, what, want, got):
        if want == got:
            self.passed += 1
        else:
            self.failed += 1
            print('%s: %r, and %r is expected' % (what, got, want))


def peers_of(program, files):
    out = subprocess.run([program] + files, capture_output=True, text=True).stdout
    for line in out.splitlines():
        who, file, v, e, f, c = line.rsplit(' ', 5)[0:6]
        yield who, file, [None if x == '-' else int(x) for x in (v, e, f, c)]


def assimp_faces(path):
    out = subprocess.run(['assimp', 'info', path, '-r'], capture_output=True, text=True).stdout
    found = re.search(r'^Faces:\s+(\d+)', out, re.M)
    return int(found[1]) if found else None


def export_all(daemon, mesh, folder, name):
    paths = []
    for kind, encoding in EXPORTS:
        query = '?format=' + kind + ('&encoding=' + encoding if encoding else '')
        status, body = daemon.send('GET', '/v1/meshes/%s/content%s' % (mesh, query))
        path = os.path.join(folder, '%s%s.%s' % (name, encoding, kind))
        with open(path, 'wb') as f:
            f.write(body if status == 200 else b'')
        paths.append((kind, path))
    return paths


def check_exports(tally, daemon, reference, program, paths, summary):
    """Requires that the other readers, and the daemon itself, find in each file what the mesh has.
    """
    counts = summary['counts']
    sides = {int(k): n for k, n in summary['degrees'].items()}
    corners = sum(k * n for k, n in sides.items())
    split = sum((k - 2) * n for k, n in sides.items())
    for kind, path in paths:
        if kind == 'glb':
            continue
        flat = kind == 'stl'
        faces = split if flat else counts['faces']
        edges = counts['edges'] + (split - counts['faces'] if flat else 0)
        for who, _, (v, e, f, c) in peers_of(program, [path]):
            want = [counts['vertices'], edges if e is not None else None, faces,
                    3 * split if flat else corners]
            tally.check('%s of %s' % (who, path), want, [v, e, f, c])
    for kind, path in paths:
        flat = kind in ('stl', 'glb')
        tally.check('assimp of ' + path, split if flat else counts['faces'], assimp_faces(path))
        body = open(path, 'rb').read()
        if reference is not None:
            m = getattr(reference, 'parse_' + kind)(body)
            v, f = reference.weld(m.v, m.f)
            tally.check('reference of ' + path, (counts['vertices'], split if flat else counts['faces']),
                        (len(v), len(f)))
        _, again = daemon.read(kind, body)
        # a GLB comes back with its polygons, an STL as triangles
        whole = kind != 'stl'
        tally.check('daemon of ' + path, (counts['vertices'], counts['faces'] if whole else split),
                    (again['counts']['vertices'], again['counts']['faces']))


def check_theirs(tally, daemon, program, folder, path, summary):
    """Requires that files of the other programs are read with the counts of the mesh that they had
    read."""
    counts = summary['counts']
    flat = all(int(k) == 3 for k in summary['degrees'])
    ran = subprocess.run([program, '--write', folder, path], capture_output=True).returncode
    tally.check('writing ' + path, 0, ran)
    files = [(who, ext, os.path.join(folder, who + '.' + ext)) for who in ('openmesh', 'cgal')
             for ext in ('obj', 'off', 'ply', 'stl')]
    for form, ext in (('obj', 'obj'), ('ply', 'ply'), ('plyb', 'ply'), ('stl', 'stl'), ('stlb', 'stl'),
                      ('glb2', 'glb')):
        out = os.path.join(folder, 'assimp-' + form + '.' + ext)
        subprocess.run(['assimp', 'export', path, out, '-f' + form], capture_output=True)
        files.append(('assimp', ext, out))
    for who, ext, file in files:
        if ext in ('stl', 'glb') and not flat:
            continue  # each program cuts polygons into triangles in its own way
        # assimp writes one vertex for each corner, so the vertices must be welded
        repair = ['weld'] if who == 'assimp' else None
        status, answer = daemon.read(ext, open(file, 'rb').read(), repair)
        want = (201, counts['vertices'], counts['edges'], counts['faces'])
        got = (status,) + tuple(answer.get('counts', {}).get(k) for k in ('vertices', 'edges', 'faces'))
        tally.check('daemon of ' + file, want, got)


def run(daemon, reference, program, folder):
    tally = Tally()
    for name, (v, f) in shapes().items():
        status, summary = daemon.create('off', as_off(v, f))
        tally.check('creating ' + name, 201, status)
        paths = export_all(daemon, summary['id'], folder, name)
        check_exports(tally, daemon, reference, program, paths, summary)
        check_theirs(tally, daemon, program, folder, dict(paths)['off'], summary)
        daemon.delete(summary['id'])
    print('note: files for other programs, and theirs: %d agree, %d do not' %
          (tally.passed, tally.failed))
    return tally.passed, tally.failed
