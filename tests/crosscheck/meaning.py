"""meaning.py - checks that the values of corners in a file mean the same to the daemon and to
assimp.

A grid whose texture has seams, whose normals have creases and whose vertices have colours is
exported in every format. assimp makes an OBJ of each file, in which every corner of a face must
have the position, texture coordinate, normal and colour that it has in the mesh, as far as the
format holds them. The daemon reads what assimp writes and welds it; the values must be the same.
assimp splits vertices and cuts polygons, so corners are compared as a set, and faces as triangles.

Materials are compared in the same way: a face must have its colour and opacity in what assimp makes
of an OBJ with its library and of a GLB, and in what the daemon reads of a GLB that assimp wrote.
"""
import json
import os
import subprocess

SIDE = 6


def grid(normals, colors, materials=False):
    """Returns a grid as OBJ: each cell of 2 x 2 quads has its own part of the texture, so that
    there is a seam around it; normals and materials change between cells, too."""
    lines = []
    for i in range((SIDE + 1) ** 2):
        x, y = i % (SIDE + 1), i // (SIDE + 1)
        color = ' %r %r %r' % (x * 36 / 255, y * 36 / 255, (i * 5 % 256) / 255) if colors else ''
        lines.append('v %d %d %d%s' % (x, y, x * y % 3, color))
    faces, vt, vn = [], [], []
    for i in range(SIDE * SIDE):
        x, y = i % SIDE, i // SIDE
        cell = x // 2 + 3 * (y // 2)
        a = y * (SIDE + 1) + x
        quad = [(a, x, y), (a + 1, x + 1, y), (a + SIDE + 2, x + 1, y + 1), (a + SIDE + 1, x, y + 1)]
        vn.append((0, 0.6, 0.8) if cell % 2 else (0, 0, 1))
        corners = []
        for v, u, w in quad:
            vt.append(((u + cell) / 16, (w + 2 * cell) / 32))
            corners.append((v + 1, len(vt), len(vn)))
        faces += [(cell, corners[:3]), (cell, [corners[0], corners[2], corners[3]])]
    lines += ['vt %r %r' % p for p in vt]
    if normals:
        lines += ['vn %r %r %r' % p for p in vn]
    for cell, f in faces:
        if materials:
            lines.append('usemtl %s' % ('red' if cell % 2 else 'blue'))
        lines.append('f ' + ' '.join('%d/%d' % c[:2] + ('/%d' % c[2] if normals else '') for c in f))
    return '\n'.join(lines) + '\n'


def faces_of(text):
    """Returns the faces of an OBJ as lists of (position, {uv, normal, color, material})."""
    v, vt, vn, material = [], [], [], None
    for line in text.splitlines():
        words = line.split()
        if words[:1] == ['v']:
            v.append(tuple(map(float, words[1:])))
        elif words[:1] == ['vt']:
            vt.append(tuple(map(float, words[1:3])))
        elif words[:1] == ['vn']:
            vn.append(tuple(map(float, words[1:])))
        elif words[:1] == ['usemtl']:
            material = words[1]
        elif words[:1] == ['f']:
            face = []
            for corner in words[1:]:
                i = [int(x) if x else 0 for x in (corner + '//').split('/')[:3]]
                p = v[i[0] - 1]
                face.append((p[:3], {'uv': vt[i[1] - 1] if i[1] else None,
                                     'normal': vn[i[2] - 1] if i[2] else None,
                                     'color': p[3:6] or None, 'material': material}))
            yield face


def corners_of(text, parts):
    """Returns the corners of an OBJ as (position, uv, normal, colour), without the values that are
    not in `parts`."""
    return {(place,) + tuple(tuple(round(x, 4) for x in said[k]) if said[k] else None
                             for k in parts)
            for face in faces_of(text) for place, said in face}


def run_assimp(form, path, out):
    subprocess.run(['assimp', 'export', path, out, '-f' + form], capture_output=True)
    return os.path.exists(out)


# What each format keeps of the values of corners; colours are those of vertices.
EXPORTS = [('obj', '', ('uv', 'normal', 'color')), ('glb', '', ('uv', 'normal', 'color')),
           ('ply', '', ('uv', 'normal', 'color')), ('ply', 'ascii', ('uv', 'normal', 'color')),
           ('ply', 'binary_big_endian', ('uv', 'normal', 'color')), ('off', '', ('color',))]
THEIRS = [('obj', 'obj'), ('glb2', 'glb'), ('ply', 'ply'), ('plyb', 'ply')]


def export(daemon, mesh, kind, encoding=''):
    query = '?format=' + kind + ('&encoding=' + encoding if encoding else '')
    return daemon.send('GET', '/v1/meshes/%s/content%s' % (mesh, query))[1]


def check_ours(tally, daemon, folder, mesh, name, text, kept):
    for kind, encoding, held in EXPORTS:
        parts = [k for k in held if k in kept]
        path = os.path.join(folder, '%s-%s.%s' % (name, encoding, kind))
        with open(path, 'wb') as f:
            f.write(export(daemon, mesh, kind, encoding))
        out = path + '.out.obj'
        said = corners_of(open(out).read(), parts) if run_assimp('obj', path, out) else None
        tally.check('corners by assimp of ' + path, corners_of(text, parts), said)


def check_theirs(tally, daemon, folder, name, text, kept):
    source = os.path.join(folder, name + '.obj')
    with open(source, 'w') as f:
        f.write(text)
    for form, kind in THEIRS:
        if form == 'plyb' and 'color' in kept:
            continue  # assimp 5.2 writes floats for colours that its header says are bytes
        path = os.path.join(folder, '%s-assimp-%s.%s' % (name, form, kind))
        if not run_assimp(form, source, path):
            tally.check('assimp writes ' + path, True, False)
            continue
        status, answer = daemon.create(kind, open(path, 'rb').read(), ['weld'])
        tally.check('daemon of ' + path, (201, (SIDE + 1) ** 2),
                    (status, answer.get('counts', {}).get('vertices')))
        if status == 201:
            said = corners_of(export(daemon, answer['id'], 'obj').decode(), kept)
            # a weld leaves colours at corners only where they differ, and OBJ cannot have any there
            tally.check('corners of ' + path, corners_of(text, kept), said)
            daemon.delete(answer['id'])


# The base colour and the opacity of materials, by name.
LOOKS = {'red one': (1, 0.25, 0, 1), 'green': (0, 0.75, 0.125, 0.5), 'blue': (0, 0, 1, 1)}


def paint(text):
    """Gives the rows of faces of a grid the materials in turn, so that the faces of a material are
    not all together."""
    names, lines, n = list(LOOKS), [], 0
    for line in text.splitlines():
        if line.startswith('f '):
            lines.append('usemtl ' + names[n // SIDE % len(names)])
            n += 1
        lines.append(line)
    return '\n'.join(lines) + '\n'


def painted(text, library, numbers=4):
    """Returns the faces of an OBJ with its library as (positions, material, this many numbers of
    its colour)."""
    looks, v, out, at = {}, [], set(), None
    for words in (line.split(None, 1) for line in library.splitlines() if line.strip()):
        if words[0] == 'newmtl':
            name = words[1].strip()
            looks[name] = [0, 0, 0, 1]
        elif words[0] == 'Kd':
            looks[name][:3] = map(float, words[1].split())
        elif words[0] == 'd':
            looks[name][3] = float(words[1])
    for words in (line.split() for line in text.splitlines()):
        if words[:1] == ['v']:
            v.append(tuple(map(float, words[1:4])))
        elif words[:1] == ['usemtl']:
            at = ' '.join(words[1:])
        elif words[:1] == ['f']:
            places = tuple(sorted(v[int(c.split('/')[0]) - 1] for c in words[1:]))
            out.add((places, at, tuple(round(x, 4) for x in looks.get(at, ())[:numbers])))
    return out


def library_of(path):
    """Returns the library of materials that assimp wrote beside an OBJ."""
    path = path[:-len('obj')] + 'mtl'
    return open(path).read() if os.path.exists(path) else ''


def check_materials(tally, daemon, folder):
    text = paint(grid(False, False))
    _, answer = daemon.create('obj', text.encode())
    mesh = answer['id']
    for name, look in LOOKS.items():
        edit = json.dumps({'op': 'material_set', 'name': name, 'base_color': look})
        status, _ = daemon.send('POST', '/v1/meshes/%s/edits' % mesh, edit.encode(),
                                'application/json')
        tally.check('material_set ' + name, 200, status)
    library = ''.join('newmtl %s\nKd %r %r %r\nd %r\n' % ((n,) + k) for n, k in LOOKS.items())
    wanted = painted(text, library)
    own = export(daemon, mesh, 'mtl').decode()
    tally.check('faces of our obj', wanted, painted(export(daemon, mesh, 'obj').decode(), own))
    with open(os.path.join(folder, 'materials.mtl'), 'w') as f:
        f.write(own)
    for kind in ('obj', 'glb'):
        path = os.path.join(folder, 'materials.' + kind)
        with open(path, 'wb') as f:
            f.write(export(daemon, mesh, kind))
        out = os.path.join(folder, 'materials-%s.out.obj' % kind)
        said = painted(open(out).read(), library_of(out)) if run_assimp('obj', path, out) else None
        tally.check('materials by assimp of ' + path, wanted, said)
        theirs = os.path.join(folder, 'materials-assimp-%s.glb' % kind)
        if not run_assimp('glb2', path, theirs):
            tally.check('assimp writes ' + theirs, True, False)
            continue
        status, answer = daemon.create('glb', open(theirs, 'rb').read(), ['weld'])
        tally.check('daemon of ' + theirs, 201, status)
        if status == 201:
            # if assimp 5.2 reads a GLB and writes a GLB, it multiplies an opacity with itself, so
            # this is not compared
            numbers = 4 if kind == 'obj' else 3
            back = painted(export(daemon, answer['id'], 'obj').decode(),
                           export(daemon, answer['id'], 'mtl').decode(), numbers)
            tally.check('materials of ' + theirs, painted(text, library, numbers), back)
            daemon.delete(answer['id'])
    daemon.delete(mesh)


EDITS = [{'op': 'weld', 'tolerance': 0}, {'op': 'face_poke', 'face': 3, 'position': [1.25, 0.75, 1]},
         {'op': 'edge_split', 'edge': 20, 't': 0.25},
         {'op': 'vertex_move', 'vertex': 2 * (SIDE + 1) + 2, 'by': [0, 0, 0.5]}]


def check_edited(tally, daemon, folder, mesh, name):
    """Requires that assimp reads in an edited mesh what our OBJ of this mesh says."""
    status, _ = daemon.send('POST', '/v1/meshes/%s/edits' % mesh,
                            json.dumps({'ops': EDITS}).encode(), 'application/json')
    tally.check('edits of ' + name, 200, status)
    text = export(daemon, mesh, 'obj').decode()
    kept = corners_of(text, ['uv']) & corners_of(grid(True, False), ['uv'])
    # all corners except the four at the vertex that moved
    tally.check('corners that edits left', (SIDE // 2 * 3) ** 2 - 4, len(kept))
    check_ours(tally, daemon, folder, mesh, name + '-edited', text, ['uv'])


def run(daemon, folder, tally):
    check_materials(tally, daemon, folder)
    for name, normals, colors in (('seams', True, False), ('colors', False, True), ('all', True, True)):
        text = grid(normals, colors)
        kept = ['uv'] + ['normal'] * normals + ['color'] * colors
        status, answer = daemon.create('obj', text.encode())
        tally.check('creating ' + name, 201, status)
        check_ours(tally, daemon, folder, answer['id'], name, text, kept)
        check_theirs(tally, daemon, folder, name, text, kept)
        check_edited(tally, daemon, folder, answer['id'], name)
        daemon.delete(answer['id'])
