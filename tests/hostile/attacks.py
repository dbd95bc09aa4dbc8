"""attacks.py - the table of all attacks: what is sent, which requests follow, and how these must
end.

A row is a file of less than a megabyte and the requests about the mesh made from it. Its statuses
are the only ones that may be answered: an attack that is refused must be refused by the right rule,
and a mesh that is large but legitimate must be accepted.
"""
import gzip
import json

import meshes


class Ask:
    """A request about the mesh of its row, whose path is put before `path`. `most`: the
    milliseconds for which the request may hold a thread of the pool, if it has a limit of its own.
    """

    def __init__(self, name, method, path='', body=b'', statuses=(200,), headers=(), most=None):
        self.name, self.method, self.path, self.statuses = name, method, path, statuses
        self.most = most
        self.body = json.dumps(body).encode() if isinstance(body, (dict, list)) else body
        typed = any(header.startswith('Content-Type:') for header in headers)
        self.headers = [*headers] if typed or not self.body else ['Content-Type: application/json',
                                                                  *headers]


class Row:
    def __init__(self, name, file, asks=(), statuses=(201,), query='', headers=(), quick=False):
        self.name, self.make, self.asks, self.statuses = name, file, asks, statuses
        self.query, self.headers, self.quick = query, headers, quick


def get(name, path, *statuses, most=None):
    return Ask(name, 'GET', path, statuses=statuses or (200,), most=most)


def query(name, *questions, statuses=(200, 413)):
    return Ask(name, 'POST', '/query', {'queries': list(questions)}, statuses)


def jobs(ask):
    """Returns the request for a mesh so large that it must become a job."""
    return Ask(ask.name, ask.method, ask.path, ask.body, (202,), ask.headers)


def maybe_jobs(ask):
    return Ask(ask.name, ask.method, ask.path, ask.body, (202, *ask.statuses), ask.headers)


def edit(op, statuses=(200, 202), **arguments):
    return Ask(op, 'POST', '/edits', {'op': op, **arguments}, statuses)


# The statuses that a row may end with: done, or refused by a rule that has a name.
ENDS = (200, 202, 400, 409, 413, 422)

# A request that may become a job may be answered with 202.
CHECK = get('check', '/check', 200, 202)
CROSSINGS = get('crossings', '/check?self_intersections=true', 200, 202, 413)
STL = get('STL', '/content?format=stl')
GLB = get('GLB', '/content?format=glb')
PACKED = get('packed GLB', '/content?format=glb&compress=meshopt')
JSON = get('JSON', '/content?format=json')
ASCII = get('PLY text', '/content?format=ply&encoding=ascii')
GEOMETRY = get('geometry', '/geometry')
# A progressive mesh must consist of triangles.
PROGRESSIVE = get('progressive', '/progressive', 200, 202, 413, 422)
RAY = query('ray', {'ray': {'origin': [0.3, 0.2, -1e5], 'direction': [0, 0, 1]}})
RAYS = query('500 rays', *[{'ray': {'origin': [i % 25 * 999 - 9000.0, i // 25 * 999 - 9000.0, -1e5],
                                    'direction': [0.001, 0.002, 1]}} for i in range(500)])
SIDEWAYS = query('500 rays in the plane', *[{'ray': {'origin': [-1e5, i - 250.0, 0],
                                                     'direction': [1, 0, 0]}} for i in range(500)])
CLOSEST = query('500 nearest points', *[{'closest': [i * 77.0, 0, 1e6]} for i in range(500)])
CROSS = query('crossings asked', {'self_intersections': {'limit': 10}})
CROSS_OFTEN = query('400 times crossings asked', *[{'self_intersections': {}}] * 400)
MEASURES = [query(name + ' of all', {'measure': name, 'of': {kind: 'all'}}) for name, kind in (
    ('normal', 'vertices'), ('mean_curvature', 'vertices'), ('gaussian_curvature', 'vertices'),
    ('area', 'faces'), ('normal', 'faces'), ('dihedral', 'edges'), ('normal', 'halfedges'))]
WALKS = [
    Ask('breadth first', 'POST', '/traverse', {'walk': 'breadth_first', 'from': {'vertex': 0}},
        (200, 413)),
    Ask('shortest path', 'POST', '/traverse',
        {'walk': 'shortest_path', 'from': {'vertex': 1}, 'to': {'vertex': 2}}, (200, 413)),
    Ask('a path of many steps', 'POST', '/traverse',
        {'walk': 'path', 'from': {'halfedge': 0}, 'path': ['twin', 'next'], 'repeat': 4000000},
        (200, 413)),
]
HUB = [
    get('faces of a vertex', '/vertices/0/faces'),
    query('10,000 times the faces of a vertex',
          *[{'relation': 'faces', 'of': {'vertex': 0}}] * 10000),
    query('10,000 searches for a half-edge', *[{'find': 'halfedge', 'vertices': [0, 1]}] * 10000),
    query('relations of all', {'relation': 'vertices', 'of': {'vertices': 'all'}},
          {'relation': 'faces', 'of': {'faces': 'all'}}),
]
TABLES = [get('a page of vertices', '/vertices?limit=10000'), get('summary', ''),
          Ask('vertices as lines', 'GET', '/vertices', headers=['Accept: application/x-ndjson']),
          get('components', '/components'), get('components by edge', '/components?by=edge'),
          get('boundaries', '/boundaries'),
          Ask('content in zstd', 'GET', '/content?format=obj', headers=['Accept-Encoding: zstd'])]
POLYGON = [CHECK, CROSSINGS, STL, GLB, GEOMETRY, RAY, CLOSEST, *MEASURES[3:5],
           edit('triangulate'), Ask('undo', 'POST', '/undo'),
           edit('dual', (200, 202, 422)), edit('face_poke', face=0)]
# Requests for a mesh with large faces, which do not change it.
FACETS = [CHECK, STL, GLB, GEOMETRY, RAY, CLOSEST,
          edit('triangulate', ENDS, dry_run=True), edit('dual', ENDS, dry_run=True)]
SURFACE = [CHECK, CROSSINGS, STL, GLB, GEOMETRY, PROGRESSIVE, RAYS, SIDEWAYS, CLOSEST, CROSS,
           CROSS_OFTEN, *MEASURES, *WALKS, *HUB, *TABLES]
COPY = Ask('copy', 'POST', '/copy', statuses=(201, 202, 415), body=b'')


def zipped(make):
    kind, body = make()
    return kind, gzip.compress(body, 9)


def listed(name, ops):
    """Returns a list of operations as long as a megabyte allows."""
    room, kept = 990000, []
    for op in ops:
        room -= len(json.dumps(op)) + 2
        if room < 0:
            break
        kept.append(op)
    return Ask(name, 'POST', '/edits', {'dry_run': True, 'ops': kept}, ENDS)


# Edits of a fan around vertex 0: triangle i is (0, i + 1, i + 2); edge 0 and the even edges are the
# spokes.
AT_HUB = [
    listed('the hub split at each spoke', ({'op': 'vertex_split', 'vertex': 0, 'left': i,
                                            'right': i + 1, 'to': [0, 0, 1]}
                                           for i in range(1, 50000, 2))),
    listed('the hub welded with each second of its rim', ({'op': 'vertex_weld', 'vertices': [0, i]}
                                                          for i in range(1, 50000, 2))),
    listed('neighbours of the rim welded', ({'op': 'vertex_weld', 'vertices': [i, i + 1]}
                                            for i in range(1, 50000, 2))),
    *[listed(f'{op} of each edge', ({'op': op, 'edge': i, **more} for i in range(150000)))
      for op, more in (('edge_cut', {}), ('edge_split', {}), ('edge_collapse', {}),
                       ('edge_bevel', {'width': 1}), ('face_join', {}))],
    listed('edge_cut of each spoke', ({'op': 'edge_cut', 'edge': i} for i in (0, *range(2, 120000, 2)))),
    listed('face_join of each spoke', ({'op': 'face_join', 'edge': i}
                                       for i in (0, *range(2, 120000, 2)))),
    *[listed(f'{op} again and again', [{'op': op, **more}] * 60000)
      for op, more in (('weld', {'tolerance': 0}), ('weld', {'tolerance': 1e-9}),
                       ('plane_cut', {'point': [0, 0, -9], 'normal': [0, 0, 1]}),
                       ('delaunay', {}), ('reverse', {}), ('decimate', {'ratio': 0.99}))],
]
LISTED_FACES = [Ask(op + ' of a list of faces', 'POST', '/edits',
                    {'op': op, 'faces': list(range(30000)), 'dry_run': True, **more}, ENDS)
                for op, more in (('face_inset', {'factor': 0.5}), ('face_extrude', {'by': [0, 0, 1]}),
                                 ('face_triangulate', {}), ('face_delete', {}))]

ZIP = ('Content-Encoding: gzip',)
REPAIRS = '&repair=weld,drop_degenerate,drop_duplicates,orient,split,fill'

ROWS = [
    # fans: all triangles meet in one vertex, in one plane
    Row('flat fan of 2,500', lambda: meshes.fan(2500), SURFACE, quick=True),
    Row('flat fan of 10,000', lambda: meshes.fan(10000), SURFACE),
    Row('flat fan of 60,000', lambda: meshes.fan(60000), SURFACE),
    Row('cone of 10,000', lambda: meshes.cone(10000), SURFACE),
    Row('cone of 60,000', lambda: meshes.cone(60000), SURFACE),
    Row('folded fan of 2,500', lambda: meshes.folded_fan(2500), SURFACE, quick=True),
    Row('folded fan of 60,000', lambda: meshes.folded_fan(60000), SURFACE),
    Row('fan of 10,000, wound 50 times', lambda: meshes.wound_fan(10000), SURFACE),
    Row('flat fan of 30,000, welded', lambda: meshes.fan(30000),
        [edit('weld', tolerance=0), edit('weld', ENDS, tolerance=8),
         edit('weld', ENDS, tolerance=1e9), Ask('undo', 'POST', '/undo', statuses=(200, 409))]),
    Row('bipyramid of 50,000', lambda: meshes.bipyramid(25000), [
        *SURFACE,
        Ask('3,000 times the hub split and joined', 'POST', '/edits', {'ops': [
            op for i in range(3000) for op in (
                {'op': 'vertex_split', 'vertex': 0, 'left': 1, 'right': 12500, 'to': [0, 0, 30000],
                 'as': f's{i}'},
                {'op': 'edge_collapse', 'edge': f'$s{i}.edge', 't': 0})]}, ENDS),
        Ask('3,000 spokes split', 'POST', '/edits', {'ops': [
            {'op': 'edge_split', 'edge': 3 * i} for i in range(3000)]}, ENDS),
        Ask('summary of many components', 'GET', '/components'),
        edit('decimate', faces=10), Ask('undo', 'POST', '/undo', statuses=(200, 409)),
        edit('subdivide', ENDS, scheme='loop', steps=2), edit('delaunay'),
        edit('plane_cut', ENDS, point=[0, 0, 0], normal=[1, 0.5, 0], cap=True)]),
    Row('fan far away', lambda: meshes.fan_at(20000, 1e12),
        [CHECK, CROSSINGS, GEOMETRY, PROGRESSIVE, RAY, CLOSEST, edit('delaunay'),
         edit('decimate', faces=10)]),
    Row('fan of a parabola', lambda: meshes.parabola(20000),
        [edit('delaunay', (200, 202, 413)), CHECK, CROSSINGS, PROGRESSIVE,
         edit('decimate', faces=10)]),

    Row('flat fan of 60,000, lists of operations', lambda: meshes.fan(60000),
        [*AT_HUB, *LISTED_FACES]),
    Row('flat fan of 3,200, lists of operations', lambda: meshes.fan(3200), AT_HUB, quick=True),
    Row('60,000 fans about one vertex', lambda: meshes.pinwheel(30000),
        [*AT_HUB, *LISTED_FACES[:1], CHECK, PROGRESSIVE, edit('separate_bowties'),
         Ask('undo', 'POST', '/undo')]),
    Row('two hubs and 60,000 quads', lambda: meshes.lantern(60000),
        [*LISTED_FACES, edit('triangulate', ENDS), Ask('undo', 'POST', '/undo', statuses=(200, 409)),
         edit('dual', ENDS), *MEASURES]),
    *[Row(f'two hubs on one rim, {where}', lambda right=right, z=z: meshes.two_hubs(24000, right, z),
          [CHECK, CROSSINGS, CROSS_OFTEN])
      for where, right, z in (('beside it', 30000, 0), ('one over the other', -20000, 0),
                              ('one above the other', -20000, 5))],
    Row('a book of 20,000 loose pages', lambda: meshes.loose_book(20000), [CHECK, CROSSINGS, CROSS]),
    Row('pyramid of 50,000', lambda: meshes.pyramid(50000), [*FACETS, *MEASURES]),
    Row('prism of 30,000', lambda: meshes.prism(30000), [*FACETS, *MEASURES]),
    Row('230 stars of 256', lambda: meshes.stars(230, 256),
        [PROGRESSIVE, edit('decimate', faces=1), Ask('undo', 'POST', '/undo'),
         edit('decimate', faces=1, boundary_weight=0)]),
    Row('500 stars of 256 in gzip', lambda: zipped(lambda: meshes.stars_of_text(500, 256)),
        [edit('decimate', faces=1)], (201, 202), headers=ZIP),
    *[Row(f'two rows of {count:,}', lambda count=count: meshes.rows_far_apart(count),
          [edit('delaunay', ENDS)], quick=count == 1000) for count in (700, 1000, 10000, 30000)],

    # polygons that are hard to triangulate
    Row('4 combs of 15,000', lambda: meshes.combs(4, 15000), POLYGON),
    Row('40 combs of 1,500', lambda: meshes.combs(40, 1500), POLYGON, quick=True),
    Row('convex disc of 60,000', lambda: meshes.disc(60000), POLYGON),
    Row('spiral of 60,000', lambda: meshes.spiral(60000), POLYGON),
    Row('star of 60,000', lambda: meshes.star(60000), POLYGON),
    Row('bent polygon of 60,000', lambda: meshes.zigzag(60000), POLYGON),
    Row('quads that are not flat', lambda: meshes.saddles(180),
        [*SURFACE, edit('triangulate'), edit('dual', (200, 202, 422)),
         edit('subdivide', steps=1)]),

    # soups, in which faces cross each other
    Row('5,000 needles through a point', lambda: meshes.needles(5000), SURFACE),
    Row('20,000 needles through a point', lambda: meshes.needles(20000), [CROSSINGS, CROSS, RAYS]),
    Row('10,000 triangles, every box in every other', lambda: meshes.stack(10000), SURFACE),
    Row('20,000 triangles in one place', lambda: meshes.plates(20000),
        [CHECK, CROSSINGS, CROSS, RAYS, CLOSEST, edit('weld', (200, 202, 413, 422), tolerance=0)]),
    Row('60,000 vertices in one cell of a grid', lambda: meshes.cells(60000),
        [CHECK, get('check with merge', '/check?merge=10', 200, 202),
         edit('weld', (200, 202, 413, 422), tolerance=0.1),
         edit('weld', (200, 202, 413, 422), tolerance=1e6)]),
    Row('55,000 vertices as dense as can be', lambda: meshes.lattice(48),
        [get(f'check with merge={merge}', f'/check?merge={merge}', 200, 202)
         for merge in (0.001, 1.4, 1.42)] + [edit('weld', tolerance=1.4)]),
    Row('60,000 vertices in one place', lambda: meshes.one_place(60000),
        [CHECK, edit('weld', (200, 202, 413, 422), tolerance=0)]),
    Row('60,000 vertices in a row', lambda: meshes.almost_one_place(60000),
        [get('check with merge', '/check?merge=3', 200, 202),
         edit('weld', (200, 202, 413, 422), tolerance=3)]),

    # files that are hard to repair
    Row('a book of 60,000 pages', lambda: meshes.book(60000), statuses=(422,)),
    Row('a book of 60,000 pages, split', lambda: meshes.book(60000), [CHECK], (201, 202, 422),
        query='&repair=split'),
    Row('20,000 triangles in one place, repaired', lambda: meshes.plates(20000), [CHECK],
        (201, 202, 422), query=REPAIRS + '&tolerance=0'),
    Row('60,000 vertices in one cell, welded', lambda: meshes.cells(60000), [CHECK],
        (201, 202, 422), query='&repair=weld&tolerance=1'),
    Row('flat fan of 60,000, repaired', lambda: meshes.fan(60000), [CHECK], (201, 202),
        query=REPAIRS + '&tolerance=1&hole_edges=100000'),

    # JSON texts and compressed bodies
    Row('400,000 brackets', lambda: meshes.nested(400000), statuses=(400, 413), quick=True),
    Row('a number of 900,000 digits', lambda: meshes.long_number(900000), statuses=(400, 413),
        quick=True),
    Row('900 numbers of 1,000 digits', lambda: meshes.long_numbers(300, 1000),
        statuses=(201, 400)),
    Row('60,000 members', lambda: meshes.many_members(60000), statuses=(400, 413), quick=True),
    Row('20,000 groups', lambda: meshes.many_groups(20000)),
    Row('100,000 times one face', lambda: meshes.repeated_face(100000), statuses=(422,)),
    Row('100,000 times one face, repaired', lambda: meshes.repeated_face(100000),
        statuses=(201, 202, 422), query=REPAIRS + '&tolerance=0'),
    Row('100 MB of zeros in gzip', lambda: ('model/obj', gzip.compress(bytes(10 ** 8), 9)),
        statuses=(400, 413, 422), headers=ZIP, quick=True),
    Row('40 MB of vertices in gzip', lambda: zipped(lambda: meshes.runs(40000000)),
        [CHECK, PROGRESSIVE], statuses=(201, 202), headers=ZIP),
    Row('100 MB of vertices in gzip', lambda: zipped(lambda: ('model/obj', b'v 0 0 0\n' * 12500000)),
        statuses=(201, 202, 413), headers=ZIP),
    Row('30 MB of one face in gzip',
        lambda: zipped(lambda: ('model/obj', b'v 0 0 0\nf' + b' 1' * 15000000)),
        statuses=(413, 422), headers=ZIP),
    Row('20 MB of brackets in gzip', lambda: zipped(lambda: meshes.nested(20000000)),
        statuses=(400, 413), headers=ZIP),

    # bodies of several files, and compressed parts of a file
    Row('900,000 carriage returns between two delimiters',
        lambda: meshes.parts(('a.bin', b'\r' * 900000)), statuses=(422,), quick=True),
    Row('64 files', lambda: meshes.parts(*((f'{i}.obj', b'v 0 0 0\n' * 1500) for i in range(64))),
        statuses=(422,), quick=True),
    Row('12 MB of corners packed in 200 KB, twice', lambda: meshes.packed_zeros(3 << 18, 2),
        statuses=(201, 202)),
    Row('12 MB of corners packed in 200 KB, 20 times', lambda: meshes.packed_zeros(3 << 18, 20),
        statuses=(413,)),

    # short requests that create large meshes
    Row('a torus of 300,000 faces', lambda: ('application/json', json.dumps(
        {'shape': 'torus', 'major_segments': 600, 'minor_segments': 500}).encode()),
        [edit('dual'), Ask('undo', 'POST', '/undo', statuses=(200, 409)), CHECK, CROSSINGS, STL, GLB, PACKED, GEOMETRY,
         JSON, ASCII, *MEASURES, *TABLES, edit('subdivide'), edit('triangulate'),
         PROGRESSIVE, COPY], (201, 202)),
    Row('an icosphere of 80,000 faces', lambda: (
        'application/json', b'{"shape":"icosphere","subdivisions":6}'),
        [PROGRESSIVE, CROSS_OFTEN, RAYS, CLOSEST, edit('decimate', faces=10),
         edit('delaunay')], (201, 202)),
    # A file is sent at once however large the mesh is; the manual says what that costs. A ray and
    # nearest points are quick if an earlier job built the tree of boxes before it was cancelled.
    Row('a torus of a million faces', lambda: ('application/json', json.dumps(
        {'shape': 'torus', 'major_segments': 1000, 'minor_segments': 1000}).encode()),
        [get('packed GLB', '/content?format=glb&compress=meshopt', most=2000),
         CHECK, get('check with merge', '/check?merge=0.01', 200, 202),
         get('crossings', '/check?self_intersections=true', 202),
         *map(maybe_jobs, (RAY, CLOSEST)), jobs(CROSS), jobs(CROSS_OFTEN),
         get('STL', '/content?format=stl', most=2000), GLB, GEOMETRY, JSON, ASCII,
         *map(maybe_jobs, MEASURES), *map(maybe_jobs, WALKS), maybe_jobs(HUB[3]), *TABLES,
         COPY], (201, 202)),
    Row('an icosphere of 1,300,000 faces', lambda: (
        'application/json', b'{"shape":"icosphere","subdivisions":8}'),
        [jobs(PROGRESSIVE), CHECK, jobs(RAYS), get('STL', '/content?format=stl', most=2000), GLB],
        (201, 202)),
]


# --- the rows of the table of operations ---

REPEATED = 3000
STRIDE = 16  # distance of ids, so that an operation does not name what the previous one changed


def argument(parameter, count):
    """Returns a value for a parameter that causes much work; None to leave the parameter out."""
    kind = parameter['type']
    if 'default' in parameter or not parameter['required']:
        return None
    if parameter.get('plural'):
        return parameter['plural'], list(range(count if kind == 'vertex' else count - 1))
    values = {'vertex': 0, 'halfedge': 0, 'edge': 0, 'face': 0, 'point': [0.5, 0.25, 0.5],
              'points': [0.5, 0.25, 0.5], 'number': 0.5, 'integer': 10, 'flag': True,
              'vertices': [1, 2, 3], 'choice': parameter.get('choices', [None])[0],
              'matrix': [2, 0, 0, 1, 0, 3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], 'mesh': 'hostile', 'text': 'hostile'}
    return parameter['name'], values[kind]


def repeated(operation, arguments, times):
    """Returns a list of operations, each at the hub but on another edge or face around it."""
    kinds = {p['name']: p['type'] for p in operation['params']}
    ops = [{'op': operation['name'],
            **{name: (STRIDE * i if kinds.get(name) in ('halfedge', 'edge', 'face') else value)
               for name, value in arguments.items()}} for i in range(times)]
    return Ask(f'{times} times {operation["name"]}', 'POST', '/edits', {'ops': ops}, ENDS)


def one_of_each(parameters, choose):
    """Returns, of each group of alternative parameters, the one that `choose` picks."""
    groups = {}
    for parameter in parameters:
        groups.setdefault(parameter.get('group', parameter['name']), []).append(parameter)
    return [choose(group) for group in groups.values()]


def operation_asks(operations, count):
    """Returns each operation twice: with the first and with the last of its alternative parameters
    and, if it takes one element or many, once more with the hub alone. Any refusal that names a
    rule is a good end."""
    asks, seen = [], set()
    for operation in operations:
        for choose in (lambda group: group[0], lambda group: group[-1]):
            arguments = {}
            for parameter in one_of_each(operation['params'], choose):
                value = argument(parameter, count)
                if value is not None:
                    arguments[value[0]] = value[1]
            for single in (False, True):
                if single:
                    for parameter in operation['params']:
                        if parameter.get('plural') in arguments:
                            del arguments[parameter['plural']]
                            arguments[parameter['name']] = 0
                ask = edit(operation['name'], ENDS, **arguments)
                if ask.body not in seen:
                    seen.add(ask.body)
                    ask.name += '' if not any(isinstance(v, list) and len(v) > 99
                                              for v in arguments.values()) else ' of all'
                    asks.append(ask)
            if operation['size'] == 'local':
                ask = repeated(operation, arguments, REPEATED)
                if ask.body not in seen:
                    seen.add(ask.body)
                    asks.append(ask)
    return asks
