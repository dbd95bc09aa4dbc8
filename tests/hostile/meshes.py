"""meshes.py - files of less than a megabyte that are made to be slow.

Each function returns a media type and the bytes of a file. Binary PLY with 16-bit indices has the
most faces in a megabyte.
"""
import json
import math
import random
import struct

LARGEST = 1000 * 1000


def ply(points, faces, coordinate='float'):
    """Returns a PLY file. `coordinate` is float or short; indices have 16 bits, and degrees as many
    as the largest one needs."""
    code = {'float': 'f', 'short': 'h', 'double': 'd'}[coordinate]
    wide = any(len(face) > 255 for face in faces)
    head = ('ply\nformat binary_little_endian 1.0\n'
            f'element vertex {len(points)}\n' +
            ''.join(f'property {coordinate} {axis}\n' for axis in 'xyz') +
            f'element face {len(faces)}\n'
            f'property list {"ushort" if wide else "uchar"} ushort vertex_indices\nend_header\n')
    rows = [struct.pack('<3' + code, *point) for point in points]
    for face in faces:
        rows.append(struct.pack(f'<{"H" if wide else "B"}{len(face)}H', len(face), *face))
    return 'model/ply', head.encode() + b''.join(rows)


def obj(points, faces):
    lines = ['v %.9g %.9g %.9g' % tuple(point) for point in points]
    lines += ['f ' + ' '.join(str(i + 1) for i in face) for face in faces]
    return 'model/obj', ('\n'.join(lines) + '\n').encode()


def circle(count, radius=1.0, z=0.0, at=(0.0, 0.0)):
    return [(at[0] + radius * math.cos(2 * math.pi * i / count),
             at[1] + radius * math.sin(2 * math.pi * i / count), z) for i in range(count)]


def spokes(count, closed=True):
    """Returns triangles from vertex 0 to a rim of `count` vertices."""
    return [(0, 1 + i, 1 + (i + 1) % count) for i in range(count if closed else count - 1)]


# --- fans ---

def fan(count):
    """A flat disc: all triangles lie in one plane, around one vertex."""
    rim = [(round(32767 * x), round(32767 * y), 0) for x, y, _ in circle(count)]
    return ply([(0, 0, 0)] + rim, spokes(count), 'short')


def cone(count):
    rim = [(round(32767 * x), round(32767 * y), 0) for x, y, _ in circle(count)]
    return ply([(0, 0, 20000)] + rim, spokes(count), 'short')


def bipyramid(count):
    """Two cones on one rim: a closed mesh with two vertices of degree `count`."""
    rim = [(round(32767 * x), round(32767 * y), 0) for x, y, _ in circle(count)]
    below = [(count + 1, i % count + 1, i) for i in range(1, count + 1)]
    return ply([(0, 0, 20000)] + rim + [(0, 0, -20000)], spokes(count) + below, 'short')


def folded_fan(count):
    """A flat fan that goes back and forth, so that its triangles lie on each other."""
    rim = [(30000, (i % 2) * 2000 + i // 32 - 1000, 0) for i in range(count)]
    return ply([(0, 0, 0)] + rim, spokes(count, False), 'short')


def wound_fan(count, turns=50):
    """A flat fan that goes around its vertex many times."""
    angle = 2 * math.pi * turns / count
    rim = [(round(32000 * math.cos(angle * i)), round(32000 * math.sin(angle * i)), 0)
           for i in range(count)]
    return ply([(0, 0, 0)] + rim, spokes(count, False), 'short')


def fan_at(count, place):
    """A fan far from the origin, where the steps between doubles are large."""
    rim = [(place + x, place + y, z) for x, y, z in circle(count)]
    return ply([(place, place, 0.0)] + rim, spokes(count), 'double')


def parabola(count):
    """A fan of a convex polygon, of which delaunay flips the diagonals again and again."""
    rim = [(i / count, (i / count) ** 2, 0.0) for i in range(count)]
    faces = [(0, i, i + 1) for i in range(1, count - 1)]
    return ply(rim, faces, 'double')


def pinwheel(count):
    """Triangles that share only one vertex: it has as many fans as triangles."""
    rim = [(round(32767 * x), round(32767 * y), 0) for x, y, _ in circle(2 * count)]
    return ply([(0, 0, 0)] + rim, [(0, 1 + 2 * i, 2 + 2 * i) for i in range(count)], 'short')


def lantern(count):
    """Quads that all have the same two opposite corners."""
    rim = [(round(32767 * x), round(32767 * y), 0) for x, y, _ in circle(count)]
    return ply([(0, 0, 20000), (0, 0, -20000)] + rim,
               [(0, 2 + i, 1, 2 + (i + 1) % count) for i in range(count)], 'short')


def two_hubs(count, right, z):
    """Two fans on one straight rim: the boxes around all triangles of one fan meet those of the
    other."""
    rim = [(0, i - count // 2, 0) for i in range(count)]
    faces = [face for i in range(count - 1) for face in ((0, 1 + i, 2 + i),
                                                         (count + 1, 2 + i, 1 + i))]
    return ply([(-30000, 0, 0)] + rim + [(right, 0, z)], faces, 'short')


def loose_book(pages):
    """Triangles that share no vertices, although they have one edge at the same place."""
    points = [point for x, y, _ in circle(pages, 30000)
              for point in ((0, 0, 0), (0, 0, 9000), (round(x), round(y), 4000))]
    return ply(points, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(pages)], 'short')


def pyramid(count):
    """A cone closed below by one face, which lies beside each edge of the rim."""
    rim = [(round(32767 * x), round(32767 * y), 0) for x, y, _ in circle(count)]
    return ply([(0, 0, 20000)] + rim, spokes(count) + [range(count, 0, -1)], 'short')


def prism(count):
    rims = [(round(32767 * x), round(32767 * y), z) for z in (0, 9000)
            for x, y, _ in circle(count)]
    sides = [(i, (i + 1) % count, count + (i + 1) % count, count + i) for i in range(count)]
    return ply(rims, [range(count - 1, -1, -1), range(count, 2 * count), *sides], 'short')


def stars(count, points, write=None):
    """Separate stars, whose hubs have as many edges as decimation still tries to collapse."""
    vertices, faces = [], []
    for s in range(count):
        hub = len(vertices)
        vertices.append((s % 100 * 300, s // 100 * 300, 0))
        vertices += [(s % 100 * 300 + round((100 + 40 * (i % 2)) * x),
                      s // 100 * 300 + round((100 + 40 * (i % 2)) * y), i * 7 % 11)
                     for i, (x, y, _) in enumerate(circle(points))]
        faces += [(hub, hub + 1 + i, hub + 1 + (i + 1) % points) for i in range(points)]
    return ply(vertices, faces, 'short') if write is None else write(vertices, faces)


def stars_of_text(count, points):
    """Stars in a text file: more of them than 16-bit indices can have."""
    return stars(count, points, obj)


def rows_far_apart(count):
    """Two rows of points, connected so that the number of flips grows with the square of their
    number."""
    points = [(i % count, i // count, 0) for i in range(2 * count)]
    faces = [face for i in range(count - 1) for face in
             ((i, i + 1, count), (count + i + 1, count + i, count - 1))]
    return ply(points, faces, 'short')


def lattice(side):
    """Points packed as densely as possible at a distance of sqrt(2)."""
    points = [(x, y, z) for x in range(side) for y in range(side) for z in range(side)
              if (x + y + z) % 2 == 0]
    return ply(points + [(0, 0, 999), (9, 0, 999), (0, 9, 999)],
               [(len(points), len(points) + 1, len(points) + 2)], 'short')


# --- polygons ---

def comb_points(corners, z=0.0):
    """The points of a comb, with teeth up from a base, so that most corners see few others."""
    teeth = corners // 2 - 1
    points = [(0.0, -1.0, z), (float(teeth), -1.0, z)]
    for i in range(teeth, 0, -1):
        points.append((float(i), 1000.0, z))
        points.append((i - 0.5, 0.0, z))
    return points


def combs(count, corners):
    points, faces = [], []
    for k in range(count):
        one = comb_points(corners, float(k))
        faces.append(range(len(points), len(points) + len(one)))
        points += one
    return ply(points, faces)


def disc(corners):
    """A disc as one convex face."""
    return ply(circle(corners), [range(corners)])


def spiral(corners):
    half = corners // 2
    inner = [((i + 10) * math.cos(i / 40), (i + 10) * math.sin(i / 40), 0.0) for i in range(half)]
    outer = [((i + 60) * math.cos(i / 40), (i + 60) * math.sin(i / 40), 0.0) for i in range(half)]
    return ply(inner + outer[::-1], [range(2 * half)])


def star(corners):
    rim = circle(corners)
    points = [(x * (1 if i % 2 else 0.001), y * (1 if i % 2 else 0.001), 0.0)
              for i, (x, y, _) in enumerate(rim)]
    return ply(points, [range(corners)])


def zigzag(corners):
    """A zigzag in space that lies in no plane, as one face."""
    half = corners // 2
    there = [(float(i), float(i % 2) * 3, float(i % 3)) for i in range(half)]
    back = [(float(i), 10.0 + float(i % 2) * 3, float(i % 5)) for i in range(half)]
    return ply(there + back[::-1], [range(2 * half)])


def saddles(side):
    """Quads that are far from planar."""
    points = [(float(x), float(y), float((x + y) % 2) * 5) for y in range(side)
              for x in range(side)]
    faces = [(y * side + x, y * side + x + 1, (y + 1) * side + x + 1, (y + 1) * side + x)
             for y in range(side - 1) for x in range(side - 1)]
    return ply(points, faces)


# --- soups ---

def needles(count):
    """Triangles that all pass through one point, so that each intersects each other."""
    r = random.Random(13)
    points, faces = [], []
    for i in range(count):
        a, b = r.uniform(0, 2 * math.pi), r.uniform(-1, 1)
        p = (math.cos(a), math.sin(a), b)
        points += [p, (-p[0], -p[1], -p[2] + 1e-3), (-p[0], -p[1] + 1e-3, -p[2])]
        faces.append((3 * i, 3 * i + 1, 3 * i + 2))
    return ply(points, faces)


def stack(count):
    """Large triangles in planes that hardly differ, so that every bounding box meets every other.
    """
    points, faces = [], []
    for i in range(count):
        z = i * 1e-6
        points += [(0.0, 0.0, z), (1.0, 0.0, z + 0.5), (0.0, 1.0, z + 0.5)]
        faces.append((3 * i, 3 * i + 1, 3 * i + 2))
    return ply(points, faces)


def plates(count):
    """Equal triangles at one place."""
    points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)] * count
    return ply(points, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(count)])


def cells(count):
    """Vertices that lie in one cell of the search grid, because a far vertex makes the cells large.
    """
    r = random.Random(14)
    points = [(r.random(), r.random(), r.random()) for _ in range(count - 3)]
    points += [(1e9, 0.0, 0.0), (0.0, 1e9, 0.0), (0.0, 0.0, 1e9)]
    return ply(points, [(count - 3, count - 2, count - 1)])


def one_place(count):
    return ply([(1, 2, 3)] * count + [(0, 0, 0), (9, 0, 0), (0, 9, 0)],
               [(count, count + 1, count + 2)], 'short')


def almost_one_place(count):
    """A row of vertices, each within the tolerance of the next."""
    points = [(i % 32000, i // 32000, 0) for i in range(count)]
    return ply(points + [(0, 0, 9), (9, 0, 9), (0, 9, 9)], [(count, count + 1, count + 2)], 'short')


# --- text ---

def nested(depth):
    return 'application/json', b'{"vertices":' + b'[' * depth


def long_number(digits):
    return 'application/json', b'{"vertices":[[' + b'1' * digits + b',0,0]],"faces":[]}'


def long_numbers(count, digits):
    number = '0.' + '123456789' * (digits // 9)
    row = '[' + ','.join([number] * 3) + ']'
    return 'application/json', ('{"vertices":[' + ','.join([row] * count) +
                                '],"faces":[]}').encode()


def many_members(count):
    return 'application/json', json.dumps({'x%d' % i: 0 for i in range(count)}).encode()


def many_groups(count):
    lines = ['v 0 0 0', 'v 1 0 0', 'v 0 1 0']
    for i in range(count):
        lines += ['g a%d' % i, 'usemtl m%d' % i, 's %d' % i]
    return 'model/obj', ('\n'.join(lines) + '\nf 1 2 3\n').encode()


def runs(size):
    """Vertices that gzip makes about fifty times smaller, which is less than the ratio that is
    allowed."""
    r = random.Random(15)
    return 'model/obj', b''.join(b'v %d 0 0\n' % r.randrange(1000) * 30
                                 for _ in range(size // 280)) + b'f 1 31 61\n'


def repeated_face(count):
    return 'model/obj', ('v 0 0 0\nv 1 0 0\nv 0 1 0\n' + 'f 1 2 3\n' * count).encode()


def book(pages):
    """Faces on one edge, which the repair has to split."""
    points = [(0, 0, 0), (0, 0, 9)] + [(round(30000 * x), round(30000 * y), 0)
                                       for x, y, _ in circle(pages)]
    return ply(points, [(0, 1, 2 + i) for i in range(pages)], 'short')


def parts(*files):
    """Returns a body of several files."""
    body = b''.join(b'--x\r\nContent-Disposition: form-data; name="%s"\r\n\r\n%s\r\n'
                    % (name.encode(), text) for name, text in files)
    return 'multipart/form-data; boundary=x', body + b'--x--'


def packed_zeros(count, views):
    """A GLB whose buffer views, all of the same compressed stream, are corners at the origin: two
    bits say that 16 bytes are 0, and the first corner is stored at the end."""
    stride = 16
    block = min(8192 // stride // 16 * 16, 256)
    blocks = [min(block, count - i) for i in range(0, count, block)]
    stream = b'\xa0' + b''.join(bytes(-(-(-(-n // 16)) // 4)) * stride for n in blocks) + bytes(32)
    packed = {'buffer': 0, 'byteLength': len(stream), 'byteStride': stride, 'count': count,
              'mode': 'ATTRIBUTES'}
    stream += bytes(-len(stream) % 4)
    text = json.dumps({
        'asset': {'version': '2.0'},
        'buffers': [{'byteLength': len(stream)}],
        'bufferViews': [{'buffer': 0, 'byteLength': count * stride, 'byteStride': stride,
                         'extensions': {'EXT_meshopt_compression': packed}}] * views,
        'accessors': [{'bufferView': i, 'componentType': 5126, 'count': count, 'type': 'VEC3'}
                      for i in range(views)],
        'meshes': [{'primitives': [{'attributes': {'POSITION': i}} for i in range(views)]}],
    }).encode()
    text += b' ' * (-len(text) % 4)
    return 'model/gltf-binary', (
        struct.pack('<4sIII4s', b'glTF', 2, 28 + len(text) + len(stream), len(text), b'JSON')
        + text + struct.pack('<I4s', len(stream), b'BIN\0') + stream)
