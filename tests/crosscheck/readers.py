"""readers.py - small files of every format are read by the daemon and by the reference reader of
the corpus.

Valid files with every feature of their formats, and files of the corpus, are changed at random: the
two readers must agree on which can be read, and on the facts of those that make a mesh. A soup that
no mesh can represent must be refused with a repair that makes it acceptable. Intended differences
are listed in KNOWN, with the reason.
"""
import base64
import collections
import json
import math
import os
import random
import re
import struct

# --- valid files ---------------------------------------------------------------------------

TET_V = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TET_F = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
CUBE_V = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE_F = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
BOW_V = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]
BOW_F = [(0, 1, 2), (0, 3, 4)]


def grid(n):
    v = [(x, y, 0.25 * ((x * 7 + y * 3) % 5)) for y in range(n + 1) for x in range(n + 1)]
    w = n + 1
    return v, [(y * w + x, y * w + x + 1, y * w + x + w + 1, y * w + x + w)
               for y in range(n) for x in range(n)]


SHAPES = [(TET_V, TET_F), (CUBE_V, CUBE_F), (BOW_V, BOW_F), grid(2), (TET_V + CUBE_V, TET_F),
          (CUBE_V, CUBE_F[:-1])]


def some_number(r, x):
    return r.choice([repr(x), '%g' % x, '%.3f' % x, '%e' % x, '+%g' % abs(x) if x >= 0 else repr(x)])


def text_of(lines, r):
    end = r.choice(['\n', '\n', '\n', '\r\n', '\r'])
    out = []
    for l in lines:
        if r.random() < 0.05:
            out.append('')
        if r.random() < 0.1:
            l = re.sub(' ', lambda m: r.choice([' ', '\t', '   ']), l)
        if r.random() < 0.05:
            l = r.choice([' ', '\t']) + l
        if r.random() < 0.05:
            l += r.choice([' ', '\t', ' # x'])
        out.append(l)
    s = end.join(out)
    return (s if r.random() < 0.2 else s + end).encode()


def make_obj(r):
    v, f = r.choice(SHAPES)
    vt, vn, color = r.random() < 0.4, r.random() < 0.4, r.choice([0, 0, 0, 1, 3, 4])
    lines = ['# made'] if r.random() < 0.5 else []
    if r.random() < 0.3:
        lines.append(r.choice(['mtllib a b.mtl', 'o thing', 'g a b', 's 1', 's off', 'xyz 1 2']))
    for p in v:
        extra = {0: [], 1: [1], 3: [0.5, 0.25, 1], 4: [0.5, 0.25, 1, 1]}[color]
        lines.append('v ' + ' '.join(some_number(r, x) for x in list(p) + extra))
    for i in range(3 if vt else 0):
        lines.append('vt ' + ' '.join(['0.5', '0.25', '0'][:r.choice([2, 3])]))
    for i in range(2 if vn else 0):
        lines.append('vn 0 0 1')
    for face in f:
        if r.random() < 0.1:
            lines.append(r.choice(['g c', 'usemtl m n', 's 3', 'o', 'g']))
        corners = []
        for i in face:
            c = str(i - len(v)) if r.random() < 0.2 else str(i + 1)
            if vt and vn:
                c += '/%d/%d' % (r.randint(1, 3), r.choice([-1, -2, 1, 2]))
            elif vt:
                c += '/%d' % r.choice([-1, 1, 3]) + r.choice(['', '', '/'])
            elif vn:
                c += '//%d' % r.randint(1, 2)
            corners.append(c)
        line = 'f ' + ' '.join(corners)
        if r.random() < 0.05:
            line = line[::-1].replace(' ', '\n\\ ', 1)[::-1]
        lines.append(line)
    return text_of(lines, r)


def make_off(r):
    v, f = r.choice(SHAPES)
    st, c, n = r.random() < 0.2, r.random() < 0.3, r.random() < 0.3
    head = ('ST' if st else '') + ('C' if c else '') + ('N' if n else '') + 'OFF'
    counts = '%d %d %s' % (len(v), len(f), r.choice(['0', '7', '12', '99']))
    if head == 'OFF' and r.random() < 0.1:
        lines = [counts]
    else:
        lines = [head + ' ' + counts] if r.random() < 0.2 else [head, counts]
    color = r.choice(['255 0 10', '0.5 0.25 1', '1 2 3 4', '0.5 0.5 0.5 1.0'])
    bare = r.random() < 0.1
    for p in v:
        line = ' '.join(some_number(r, x) for x in p)
        line += ' 0 0 1' if n else ''
        line += ' ' + color if c else ''
        line += ' 0.5 0.25' if st else ''
        if bare and r.random() < 0.5:
            line = ' '.join(line.split(' ')[:3])
        lines.append(line)
    face_color = r.choice(['', '', ' 255 0 0', ' 0.1 0.2 0.3', ' 1 2 3 4', ' 3'])
    for face in f:
        lines.append('%d %s%s' % (len(face), ' '.join(map(str, face)), face_color))
    return text_of(lines, r)


TYPES = {'char': 'b', 'int8': 'b', 'uchar': 'B', 'uint8': 'B', 'short': 'h', 'int16': 'h',
         'ushort': 'H', 'uint16': 'H', 'int': 'i', 'int32': 'i', 'uint': 'I', 'uint32': 'I',
         'float': 'f', 'float32': 'f', 'double': 'd', 'float64': 'd'}
WHOLE = [t for t in TYPES if TYPES[t] not in 'fd']


def make_ply(r):
    v, f = r.choice(SHAPES)
    encoding = r.choice(['ascii', 'binary_little_endian', 'binary_big_endian'])
    kind = r.choice(['float', 'double', 'float32', 'short', 'int'])
    if kind in ('short', 'int'):
        v = [tuple(int(x) for x in p) for p in v]
    props = [('x', kind), ('y', kind), ('z', kind)]
    for name in r.sample(['nx', 'red', 'quality', 'alpha', 'label'], r.randint(0, 3)):
        props.append((name, r.choice(list(TYPES))))
    if r.random() < 0.3:
        r.shuffle(props)
    count, index = r.choice(WHOLE), r.choice(list(TYPES))
    strips = r.random() < 0.1
    face_props = [('vertex_indices' if r.random() < 0.5 else 'vertex_index', (count, index))]
    if r.random() < 0.3:
        face_props.append((r.choice(['flags', 'red']), r.choice(list(TYPES))))
    if r.random() < 0.2:
        face_props.append(('texcoord', (r.choice(WHOLE), r.choice(['float', 'double']))))
    if r.random() < 0.2:
        r.shuffle(face_props)
    rows = [list(face) for face in f]
    if strips:
        rows = [[0, 1, 2, -1, 0, 2, 3]] if TYPES[index] in 'bhi' else [[0, 1, 2, 3]]
    elements = [('vertex', props, v), ('tristrips' if strips else 'face', face_props, rows)]
    if r.random() < 0.2:
        elements.insert(r.randint(0, 2), ('extra', [('a', 'uchar'), ('b', ('uchar', 'short'))], [(), ()]))
    if r.random() < 0.05:
        elements[0], elements[-1] = elements[-1], elements[0]
    end = r.choice(['\n', '\n', '\r\n'] + ['\r'] * (encoding == 'ascii'))
    head = ['ply', 'format %s 1.0' % encoding]
    if r.random() < 0.3:
        head.append(r.choice(['comment hello', 'obj_info x']))
    body = b''
    order = '>' if 'big' in encoding else '<'
    for name, ps, data in elements:
        head.append('element %s %d' % (name, len(data)))
        for p, t in ps:
            head.append('property list %s %s %s' % (t[0], t[1], p) if isinstance(t, tuple)
                        else 'property %s %s' % (t, p))
        for row in data:
            words = []
            for p, t in ps:
                if p in ('vertex_indices', 'vertex_index'):
                    values, kinds = [len(row)] + list(row), [t[0]] + [t[1]] * len(row)
                elif isinstance(t, tuple):
                    values, kinds = [2, 1, 2], [t[0], t[1], t[1]]
                elif p in 'xyz':
                    values, kinds = [row['xyz'.index(p)]], [t]
                else:
                    values, kinds = [r.randint(0, 99)], [t]
                if encoding == 'ascii':
                    words += ['%r' % x for x in values]
                else:
                    for x, k in zip(values, kinds):
                        body += struct.pack(order + TYPES[k], x)
            if encoding == 'ascii':
                body += (' '.join(words) + end).encode()
    return (end.join(head) + end + 'end_header' + end).encode() + body


def triangles(f):
    return [(x[0], x[i], x[i + 1]) for x in f for i in range(1, len(x) - 1)]


def make_stl(r):
    v, f = r.choice(SHAPES)
    f = triangles(f)
    if r.random() < 0.5:
        head = r.choice([b'solid made', b'made', b'', b'\0' * 80, b'solid']).ljust(80, r.choice([b'\0', b' ']))
        body = b''
        for x in f:
            p = [c for i in x for c in v[i]]
            p = [-0.0 if c == 0 and r.random() < 0.1 else c for c in p]
            body += struct.pack('<12fH', 0, 0, 0, *p, r.choice([0, 0, 0, 7]))
        return head + struct.pack('<I', len(f)) + body + b'\0' * r.choice([0, 0, 0, 1, 2, 49])
    up = (lambda s: s.upper()) if r.random() < 0.2 else (lambda s: s)
    lines = [up('solid') + r.choice(['', ' a', ' a b'])]
    for i, x in enumerate(f):
        if i and r.random() < 0.1:
            lines += [up('endsolid'), up('solid') + ' x']
        u = (lambda s: s.upper()) if r.random() < 0.1 else up
        lines += [u('facet normal') + ' 0 0 1', u('outer loop')]
        lines += [u('vertex') + ' ' + ' '.join(some_number(r, c) for c in v[j]) for j in x]
        lines += [u('endloop'), u('endfacet')]
    lines.append(up('endsolid') + r.choice(['', ' a']))
    return text_of(lines, r).replace(b' # x', b'')


def make_gltf(r):
    v, f = r.choice(SHAPES)
    f = triangles(f)
    data, views, accessors = b'', [], []

    def add(fmt, rows, kind, component, **more):
        nonlocal data
        data += b'\0' * (-len(data) % 4)
        blob = b''.join(struct.pack('<' + fmt, *row) for row in rows)
        views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(blob)})
        data += blob
        accessors.append(dict({'bufferView': len(views) - 1, 'componentType': component,
                               'count': len(rows), 'type': kind}, **more))
        return len(accessors) - 1

    position = add('3f', v, 'VEC3', 5126, min=[min(p[i] for p in v) for i in range(3)],
                   max=[max(p[i] for p in v) for i in range(3)])
    primitive = {'attributes': {'POSITION': position}}
    form = r.choice('BHI')
    mode = r.choice([4, 4, 4, 4, 5, 6, 1])
    flat = [(i,) for x in f for i in x]
    if mode == 5:
        flat = [(0,), (1,), (2,), (3,)]
    elif mode == 6:
        flat = [(0,), (1,), (2,), (3,)]
    if r.random() < 0.9:
        primitive['indices'] = add(form, flat, 'SCALAR', {'B': 5121, 'H': 5123, 'I': 5125}[form])
    if mode != 4:
        primitive['mode'] = mode
    if r.random() < 0.3:
        primitive['attributes']['NORMAL'] = add('3f', [(0, 0, 1)] * len(v), 'VEC3', 5126)
    if r.random() < 0.3:
        primitive['attributes']['TEXCOORD_0'] = add(
            '2H', [(1, 2)] * len(v), 'VEC2', 5123, normalized=True)
    if r.random() < 0.1:
        data += b'\0' * (-len(data) % 4)
        views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': 2})
        data += struct.pack('<HH', 1, 0)
        views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': 12})
        data += struct.pack('<3f', 5, 0, 0)
        accessors[position]['sparse'] = {
            'count': 1, 'indices': {'bufferView': len(views) - 2, 'componentType': 5123},
            'values': {'bufferView': len(views) - 1}}
    nodes = [{'mesh': 0}]
    if r.random() < 0.4:
        nodes[0].update(r.choice([
            {'translation': [1, 2, 3]}, {'scale': [-1, 1, 1]}, {'scale': [2, 2, 2]},
            {'rotation': [0, 0, math.sqrt(0.5), math.sqrt(0.5)]},
            {'matrix': [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 4, 5, 6, 1]}]))
    if r.random() < 0.2:
        nodes.append({'children': [0], 'translation': [0, 0, 1]})
    if r.random() < 0.2:
        nodes.append({'mesh': 0, 'translation': [10, 0, 0]})
    g = {'asset': {'version': '2.0'}, 'buffers': [{'byteLength': len(data)}],
         'bufferViews': views, 'accessors': accessors, 'meshes': [{'primitives': [primitive]}],
         'nodes': nodes}
    if r.random() < 0.8:
        children = {c for n in nodes for c in n.get('children', [])}
        g['scenes'] = [{'nodes': [i for i in range(len(nodes)) if i not in children]}]
        if r.random() < 0.8:
            g['scene'] = 0
    return g, data


def pack_glb(g, data, r):
    """Returns a GLB container, in one of four cases with something unusual about it."""
    what = r.randrange(16) if r.random() < 0.25 else -1
    text = json.dumps(g).encode()
    if what == 0:
        text = b'\xef\xbb\xbf' + text
    text += (b'\0' if what == 1 else b' ') * (-len(text) % 4 + (4 if what == 2 else 0))
    data += b'\0' * (-len(data) % 4 + r.choice([0, 0, 0, 4]))
    chunks = [(b'JSON', text), (b'BIN\0', data)]
    if what in (3, 4, 5):
        chunks.insert(what - 3, r.choice([(b'XTRA', b'abcd'), (b'BIN\0', b''), (b'JSON', b'{}  ')]))
    elif what == 6:
        chunks.reverse()
    elif what in (7, 8):
        del chunks[what - 7]
    elif what == 9:
        chunks[1] = (b'BIN\0', data[:-r.choice([1, 4])])
    body = b''
    for i, (kind, bytes_) in enumerate(chunks):
        wrong = r.choice([-4, -1, 1, 4, 2**31]) if what == 10 + i else 0
        body += struct.pack('<I4s', (len(bytes_) + wrong) % 2**32, kind) + bytes_
    whole = 12 + len(body) + (r.choice([-4, -1, 1, 4, -12]) if what == 12 else 0)
    version = r.choice([0, 1, 3]) if what == 13 else 2
    out = struct.pack('<4sII', b'glTF', version, whole) + body
    if what == 14:
        out += b'\0' * r.choice([1, 4, 8])
    elif what == 15:
        out = out[:r.randrange(len(out))]
    return out


def change_json(g, r):
    """Changes, removes or adds one member somewhere in a JSON value."""
    places = []

    def walk(o):
        if isinstance(o, dict):
            for k in o:
                places.append((o, k))
                walk(o[k])
        elif isinstance(o, list):
            for i in range(len(o)):
                places.append((o, i))
                walk(o[i])
    walk(g)
    o, k = r.choice(places)
    roll = r.random()
    if roll < 0.2 and isinstance(o, dict):
        del o[k]
    elif isinstance(o[k], (int, float)) and roll < 0.8:
        o[k] = r.choice([o[k] + 1, o[k] - 1, -o[k], 0, 1, 2, 3, 4, 5, 255, 65536, 2**32 - 1, 2**32, 2**63,
                         1e9, 0.5, 5120, 5121, 5122, 5123, 5125, 5126])
    else:
        o[k] = r.choice([0, 1, -1, None, '', 'x', [], {}, [0], True, 'VEC2', 'VEC3', 'SCALAR', [0, 0, 0],
                         [1, 0, 0, 0]])


def make_glb(r):
    g, data = make_gltf(r)
    for _ in range(r.choice([0, 0, 1, 1, 2])):
        change_json(g, r)
    return pack_glb(g, data, r)


def make_gltf_file(r):
    g, data = make_gltf(r)
    g['buffers'][0]['uri'] = ('data:application/octet-stream;base64,' +
                              base64.b64encode(data).decode())
    for _ in range(r.choice([0, 0, 1, 1, 2])):
        change_json(g, r)
    return json.dumps(g).encode()


MAKERS = {'obj': make_obj, 'off': make_off, 'ply': make_ply, 'stl': make_stl, 'glb': make_glb,
          'gltf': make_gltf_file}

# --- changes -------------------------------------------------------------------------------

TOKENS = ['0', '1', '-1', '2', '3', '4', '5', '-4', '-5', '99', '1.5', '1e3', '1e400', '1e-400', 'nan',
          'inf', '-inf', '0x10', '1_0', '4294967297', '18446744073709551617', '4294967296', '2147483648',
          '-2147483649', '1.', '.5', '.', '-', '+1', '++1', '1,5', '1/2/3', '1//', '/', 'x', '1f', '1e',
          '\\', 'OFF', 'v', 'f', 'vertex', 'endfacet', 'face', '\0', '\x7f', 'é', '00003', '-0']


def change_text(b, r):
    end = b'\n' if b'\n' in b else b'\r'
    lines = b.split(end)
    roll = r.randrange(12)
    i = r.randrange(len(lines))
    if roll == 0:
        del lines[i]
    elif roll == 1:
        lines.insert(i, lines[i])
    elif roll == 2:
        j = r.randrange(len(lines))
        lines[i], lines[j] = lines[j], lines[i]
    elif roll == 3:
        lines[i] = b''
    elif roll == 4 and i + 1 < len(lines):
        lines[i:i + 2] = [lines[i] + b' ' + lines[i + 1]]
    elif roll == 5:
        return b[:r.randrange(len(b) + 1)]
    elif roll == 6:
        at = r.randrange(len(b) + 1)
        return b[:at] + r.choice([b' ', b'\0', b'\t', b'-', b'0', b'x']) + b[at:]
    else:
        words = lines[i].split(b' ')
        j = r.randrange(len(words))
        what = r.randrange(4)
        token = r.choice(TOKENS).encode('latin-1')
        if what == 0:
            words[j] = token
        elif what == 1:
            words.insert(j, token)
        elif what == 2:
            del words[j]
        else:
            number = re.fullmatch(rb'-?\d+', words[j].strip())
            words[j] = b'%d' % (int(words[j]) + r.choice([-1, 1])) if number else words[j] + token
        lines[i] = b' '.join(words)
    return end.join(lines)


def change_bytes(b, r):
    b = bytearray(b)
    roll = r.randrange(6)
    at = r.randrange(len(b)) if b else 0
    if roll == 0:
        b[at] ^= 1 << r.randrange(8)
    elif roll == 1:
        b[at] = r.choice([0, 1, 0x7F, 0x80, 0xFF])
    elif roll == 2:
        return bytes(b[:at])
    elif roll == 3:
        b[at:at] = bytes(r.randrange(256) for _ in range(r.choice([1, 2, 4, 50])))
    elif roll == 4:
        del b[at:at + r.choice([1, 2, 4, 50])]
    else:
        b += bytes(r.choice([1, 2, 49, 50, 51, 100]))
    return bytes(b)


def changed(b, kind, r):
    for _ in range(r.choice([0, 1, 1, 1, 2, 3])):
        text = kind in ('obj', 'off') or b'\0' not in b[:2000]
        # the header of a binary PLY is text, so it is changed as text
        head = re.search(rb'end_header\r?\n', b) if kind == 'ply' else None
        if kind in ('glb', 'gltf') or not b:
            if not b or r.random() < 0.7:
                continue
            b = change_bytes(b, r)
        elif head is not None and not text and r.random() < 0.5:
            b = change_text(b[:head.end()], r) + b[head.end():]
        elif text and r.random() < 0.9:
            b = change_text(b, r)
        elif b:
            b = change_bytes(b, r)
    return b


# --- the two readers -----------------------------------------------------------------------

def near(a, b, scale=0.0):
    return abs(a - b) <= 1e-5 * max(abs(a), abs(b), scale) or abs(a - b) < 1e-9


def facts_differ(kind, facts, answer):
    """Returns whether the facts differ, for a file that both read and that makes a mesh without
    repairs."""
    r = facts['welded'] if kind == 'stl' else facts['indexed']
    c = answer['counts']
    out = []
    pairs = [('vertices', r['V'], c['vertices']), ('faces', r['F'], c['faces']),
             ('edges', r['E'], c['edges']), ('components', r['components_by_edge'], c['components_by_edge']),
             ('components', r['components'], c['components']),
             ('isolated', r['V_isolated'], c['isolated_vertices']),
             ('euler', r['euler'], answer['euler']), ('closed', r['closed'], answer['closed']),
             ('manifold', r['is_manifold'], answer['manifold']), ('genus', r['genus'], answer['genus'])]
    if r['boundary_loops'] is not None:
        pairs.append(('boundary loops', r['boundary_loops'], c['boundary_loops']))
    for name, want, got in pairs:
        if want is not None and want != got:
            out.append('%s: %r here, %r there' % (name, want, got))
    box = r['bbox'] or [[0] * 3, [0] * 3]
    size = max(map(abs, box[0] + box[1]))
    if 0 < size < 1e100 and answer['bbox'] is not None:
        if r['area_newell'] is not None and not near(r['area_newell'], answer['area'], size * size):
            out.append('area: %r here, %r there' % (r['area_newell'], answer['area']))
        if r['closed'] and r['is_manifold'] and not near(r['volume'], answer['volume'], size ** 3):
            out.append('volume: %r here, %r there' % (r['volume'], answer['volume']))
        for i, end in enumerate(('min', 'max')):
            if not all(near(a, b, size) for a, b in zip(box[i], answer['bbox'][end])):
                out.append('bbox: %r here, %r there' % (box[i], answer['bbox'][end]))
    return out


# Differences between the two readers that are intended: the format, which one refuses, with which
# words, and why.
KNOWN = [
    ('stl', 'daemon', 'facets that it declares', 'a count that lies may hide facets'),
    ('stl', 'daemon', '(in|out)side a facet|a fourth vertex in a facet|a facet has [0-9]+ corners', 'the reference drops it'),
    ('stl', 'daemon', 'control character', 'a name that nothing could show'),
    ('stl', 'daemon', 'it has no facets', 'unknown words and nothing else'),
    ('stl', 'reference', 'bad-syntax|short-vertex', 'white space is free in a text'),
    ('off', 'daemon', 'comes after the last face', 'a count that lies may hide faces'),
    ('off', 'daemon', 'the three counts|does not match what the header declares|ends after',
     'numbers that no header announces belong to the next line'),
    ('obj', 'daemon', 'cannot begin a line', 'it may have been the end of a face'),
    ('obj', 'daemon', 'numbers and needs [13]|is not a number', 'a line without its values'),
    ('obj', 'daemon', 'the body is empty|has no vertices', 'a body without a line of the format'),
    ('off ply stl', 'daemon', 'NUL byte', 'no text has one'),
    ('stl', 'reference', 'bad-number.*#', 'a comment'),
    ('obj off stl', 'reference', r'\\\\', 'a backslash that ends a line is blank'),
    ('ply', 'daemon', r'\?', 'control characters in a header'),
    ('obj', 'daemon', 'smoothing group|control character', 'the reference passes it over'),
    ('off ply', 'daemon', 'is not a number', 'of values that the reference passes over'),
    ('off', 'reference', 'short-face|bad-counts', 'what is on a line means nothing'),
    ('off', 'daemon', "no vertex -0|'-0' is not a count", 'a number that nobody writes'),
    ('ply', 'reference', 'short-row: (?!face row|vertex row)',
     'elements that nobody wants are passed over'),
    ('ply', 'daemon', "'[-+][0-9]+' is not a count", 'a number that nobody writes'),
    ('ply', 'daemon', 'ends before its last value|the file ends after',
     'a CR within a line that ends in LF is white space, not the end of a row'),
    ('ply', 'reference', 'no end_header', 'blanks may stand before it'),
    ('ply', 'reference', 'bad-header', 'other white space, and other letters than ASCII'),
    ('ply', 'daemon', 'does not fit its type', 'a value that its type cannot hold'),
    ('ply', 'daemon', 'is not a vertex index', 'the reference cuts fractions off'),
    ('ply', 'reference', 'bad-integer', 'a corner with a point, in a list of floats'),
    ('stl', 'reference', 'file ends inside a facet', 'two words on a line'),
    ('glb gltf', 'daemon', r'(accessors|bufferViews|buffers|scene|scenes|meshes|nodes)/?',
     'it is no valid glTF, also where the reference looks away'),
    ('glb', 'reference', 'unaligned-chunk', 'it is read, with a note'),
    ('ply', 'daemon', 'no properties|name of two|given twice|is an extra word', 'a header that is wrong'),
    ('ply', 'daemon', 'rows larger than a mesh can have', 'of rows without properties the reference reads any'),
]


def is_known(kind, what, words):
    who = {'accepted': 'reference', 'refused': 'daemon', 'unadvised': 'daemon'}.get(what)
    return any(kind in k.split() and who == w and re.search(r, words) for k, w, r, _ in KNOWN)


STL_WORDS = re.compile(rb'\b(?:vertex|facet|endfacet|endloop|outer|solid|endsolid)\b', re.I)


def compare(ref, daemon, kind, body):
    try:
        m = getattr(ref, 'parse_' + kind)(body)
        why = None
    except ref.Bad as e:
        m, why = None, str(e)
    except Exception as e:  # of whatever kind: it is not the program under test
        return 'unjudged', 'the reference fails: %s' % e
    # some characters are white space for Python and for no file format
    if kind != 'glb' and re.search(rb'[\v\f\x1c-\x1f\x85\xa0]', body[:500]):
        return 'unjudged', 'other white space'
    if kind == 'stl' and any(len(STL_WORDS.findall(line)) > 1 for line in re.split(b'[\r\n]', body)):
        return 'unjudged', 'two words on a line'
    text = body.split(b'end_header')[0] if kind == 'ply' else body
    ends = set(re.findall(rb'\r+\n|\r|\n', text))
    if kind in ('obj', 'off', 'ply', 'stl') and b'\0' not in text and b'\r' in ends and len(ends) > 1:
        return 'unjudged', 'a carriage return that ends no line'
    status, answer = daemon.read(kind, body)
    said = answer.get('detail', '') if status != 201 else 'read'
    if status not in (201, 400, 413, 415, 422):
        return 'status', '%d %s' % (status, said)
    if status != 201 and len(said) < 8:
        return 'words', 'a refusal without words'
    if m is None:
        return ('accepted', why) if status == 201 else (None, None)
    try:
        if any(max(map(abs, p)) > 1e150 for p in m.v):
            return 'unjudged', 'sums overflow'
        facts = {'welded': ref.analyse(*ref.weld(m.v, m.f)), 'indexed': ref.analyse(m.v, m.f)}
    except (TypeError, IndexError):
        return 'unjudged', 'the reference takes fractions for indices'
    r = facts['welded'] if kind == 'stl' else facts['indexed']
    if status == 201:
        if r['F_degenerate'] or r['E_nonmanifold'] or r['E_misoriented']:
            return 'held', 'a mesh that cannot be: %r' % {k: r[k] for k in (
                'F_degenerate', 'E_nonmanifold', 'E_misoriented', 'V_nonmanifold')}
        if not m.f and not m.v and kind != 'gltf':
            return None, None
        if any(w['code'] == 'rotation_made_unit' for w in answer['import']['warnings']):
            return 'unjudged', 'the reference scales by the length of a quaternion'
        differ = facts_differ(kind, facts, answer)
        return ('facts', '; '.join(differ)) if differ else (None, None)
    if b'tristrips' in body and 'no vertex' in said:
        return 'unjudged', 'a strip that is too short for a face'
    if r['F_degenerate'] or r['E_nonmanifold'] or r['E_misoriented'] or r['V_nonmanifold']:
        repair = answer.get('repair')
        if not repair:
            return 'unadvised', said
        status, mended = daemon.read(kind, body, repair)
        if status != 201:
            return 'advice', 'repair=%s: %s' % (','.join(repair), mended.get('detail'))
        if not mended['import']['repairs']:
            return 'advice', 'nothing is said to be repaired by ' + ','.join(repair)
        return None, None
    return 'refused', said


def run(daemon, reference, folder, count, kinds, keep, show):
    """Reads `count` files; those in which the readers differ are shown, and kept in `keep`. Returns
    how many agree and how many do not."""
    seed = int(os.environ.get('SEED') or random.SystemRandom().randrange(2**32))
    print('note: SEED=%d' % seed)
    r = random.Random(seed)
    found = {k: [] for k in kinds}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        kind = name.lower().rsplit('.', 1)[-1]
        if kind in found and os.path.getsize(path) < 20000:
            found[kind].append(open(path, 'rb').read())
    tally, shown = collections.Counter(), collections.Counter()
    for n in range(count):
        kind = kinds[n % len(kinds)]
        body = r.choice(found[kind]) if found[kind] and r.random() < 0.3 else MAKERS[kind](r)
        body = changed(body, kind, r)
        what, why = compare(reference, daemon, kind, body)
        what = 'known' if is_known(kind, what, why or '') else what
        tally[what or 'same'] += 1
        if what in (None, 'unjudged', 'known'):
            continue
        group = (kind, what, re.sub(r"\d+|'.*?'|b'.*'", '#', why)[:60])
        shown[group] += 1
        if shown[group] <= show:
            print('%s %s: %s' % (kind, what, why))
            if keep:
                path = os.path.join(keep, '%d.%s' % (n, kind))
                with open(path, 'wb') as f:
                    f.write(body)
                print('    ' + path)
    bad = sum(shown.values())
    print('note: files changed at random: ' +
          ', '.join('%d %s' % (n, k) for k, n in sorted(tally.items())))
    return sum(tally.values()) - bad, bad
