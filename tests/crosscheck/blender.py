"""blender.py - checks what Blender reads in files of the daemon: faces, and the values of their
corners.

One process of Blender reads all files (blender_read.py). A corner must have the position, texture
coordinate, normal, colour and material that it has in the mesh, as far as the format holds them and
Blender reads them: its PLY reader ignores normals, and it has no OFF reader. Blender rounds
normals, and stores colours as bytes.
"""
import json
import os
import shutil
import subprocess

import meaning
import peers

HERE = os.path.dirname(os.path.abspath(__file__))
ALL = ('uv', 'normal', 'color')
# The attributes of corners that each format keeps; materials are compared if the file has some.
EXPORTS = [('obj', '', ALL + ('material',)), ('glb', '', ALL + ('material',)),
           ('ply', '', ('uv', 'color')), ('ply', 'ascii', ('uv', 'color')),
           ('ply', 'binary_big_endian', ('uv', 'color')), ('stl', '', ()), ('stl', 'ascii', ())]
CLOSE = {'uv': 1e-5, 'normal': 2e-3, 'color': 6e-3}


def has_materials(path):
    """Returns whether a GLB has materials that other programs see, which are in its JSON."""
    with open(path, 'rb') as f:
        head = f.read(20)
        return not head.startswith(b'glTF') or \
            'materials' in json.loads(f.read(int.from_bytes(head[12:16], 'little')))


def wanted(text):
    """Returns the faces of an OBJ in the form that blender_read.py writes."""
    faces = []
    for face in meaning.faces_of(text):
        faces.append([[list(place), said['uv'], said['normal'], said['color'], said['material']]
                      for place, said in face])
    return faces


def key(corner, with_uv):
    place, uv = corner[:2]
    return (tuple(round(x, 3) for x in place),) + \
        (tuple(round(x, 3) for x in uv) if with_uv and uv else ())


def differences(want, got, parts):
    """Compares faces. Corners with equal position and texture coordinate must have equal values."""
    found = []
    if not isinstance(got, list):
        return [got]
    if len(want) != len(got):
        found.append('%d faces in place of %d' % (len(got), len(want)))
    said = {key(c, 'uv' in parts): c for face in want for c in face}
    seen = set()
    for corner in (c for face in got for c in face):
        at = key(corner, 'uv' in parts)
        seen.add(at)
        if at not in said:
            found.append('a corner at %r' % (at,))
            continue
        for i, part in enumerate(('uv', 'normal', 'color', 'material'), 1):
            a, b = said[at][i], corner[i]
            if part not in parts or a is None:
                continue
            same = a == b if part == 'material' or b is None else \
                max(abs(x - y) for x, y in zip(a, b)) <= CLOSE[part]
            if not same:
                found.append('%s of %r: %r, not %r' % (part, at, b, a))
    return found + ['no corner at %r' % (at,) for at in said if at not in seen]


def export_all(daemon, text, name, folder):
    status, answer = daemon.create('obj', text.encode())
    assert status == 201, answer
    for kind, encoding, parts in EXPORTS:
        path = os.path.join(folder, '%s-%s.%s' % (name, encoding, kind))
        with open(path, 'wb') as f:
            f.write(meaning.export(daemon, answer['id'], kind, encoding))
        yield path, kind, parts
    daemon.delete(answer['id'])


def as_obj(v, f):
    lines = ['v %r %r %r' % tuple(map(float, p)) for p in v]
    return '\n'.join(lines + ['f ' + ' '.join(str(i + 1) for i in x) for x in f]) + '\n'


def run(daemon, program, folder, tally):
    texts = {'plain': meaning.grid(False, False), 'normals': meaning.grid(True, False),
             'colors': meaning.grid(False, True), 'all': meaning.grid(True, True, True)}
    for name, (v, f) in peers.shapes().items():
        texts[name] = as_obj(v, f)
    files = [(path, kind, parts, wanted(text)) for name, text in texts.items()
             for path, kind, parts in export_all(daemon, text, name, folder)]
    out = os.path.join(folder, 'blender.json')
    # Blender's Python takes the folder of the first python3 in PATH for its home, so PATH names
    # only the system's.
    system = {'PATH': '/usr/bin:/bin', 'HOME': folder}
    said = subprocess.run([shutil.which(program) or program, '-b', '--factory-startup', '-noaudio', '-P',
                           os.path.join(HERE, 'blender_read.py'), '--', out] +
                          [path for path, *_ in files], capture_output=True, text=True, env=system)
    if not os.path.exists(out):
        tally.check('Blender', 'files that are read', said.stdout + said.stderr)
        return
    with open(out) as f:
        found = json.load(f)
    for path, kind, parts, want in files:
        parts = [k for k in parts if k != 'material' or has_materials(path)]
        cut = kind in ('stl', 'glb')
        got = found[path]
        if isinstance(got, list) and cut and any(len(face) > 3 for face in want):
            count = sum(len(face) - 2 for face in want)
            tally.check('triangles by Blender of ' + path, count, len(got))
            places = {key(c, False) for face in want for c in face}
            tally.check('places by Blender of ' + path, places,
                        {key(c, False) for face in got for c in face})
            continue
        tally.check('corners by Blender of ' + path, [], differences(want, got, parts)[:2])
