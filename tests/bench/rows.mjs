// rows.mjs - what `make bench` measures: the rows of the table, in parts.
//
// A part has an input (tests/bench/side/input.h) and the rows that are run on it. A row has these
// members:
//
//     title    its name in the table
//     ours     its name in our program, and in the others' unless `theirs` names another
//     unit     of the figure, with `per`: AMOUNT / VALUE is divided by this
//     whole    the figure is VALUE itself
//     less     the smaller figure is better: it is VALUE / AMOUNT
//     near     relative tolerance of the results; 0 if only `exact` is compared
//     drawn    the result counts edges drawn at random, not the same ones in each program: the
//              tolerance is that of the usual input, and wider if there are fewer edges
//     target   [[peer, ratio]]: our figure must be at least `ratio` times better than that of
//              `peer`; 'best' stands for the peer with the best figure
//     runs     the number of runs of each side, if it is not that of the other rows
//     fresh    each run has a process of its own
//     meter    the quantity measured, if it is not seconds (tests/bench/side/side.h)
//     limit    the largest allowed figure, if no peer is compared; with `guard` it is a limit of
//              our own that no design asks for
//     why      printed if the row misses its target or hardly meets it: the reason
//     sides    the programs besides ours, if they are not those of the part
//     note     printed instead of a figure, if there is nothing to measure
//     after    a row of ours that describes what a program has left in the folder, for comparison
//     slow     programs that run only once
//     errors   lists of rows whose figures come from a row of ours, `by`, about what each program
//              has left in the folder; `of` says which of its numbers

import { compare } from './rows_compare.mjs';
import { deform } from './rows_deform.mjs';
import { fill } from './rows_fill.mjs';
import { remesh } from './rows_remesh.mjs';
import { segment } from './rows_segment.mjs';
import { smooth } from './rows_smooth.mjs';
import { solve } from './rows_solve.mjs';

const M = 1e6;
const rate = (unit, per = M) => ({ unit, per });

const building =
    'corners are filed, sides paired and fans checked, each a pass over what the last one wrote; ' +
    'of the torus in order a quarter of the time and more is the system clearing fresh pages';

const kernel = (name, order) => ({
    part: 'build',
    input: name,
    order,
    rows: [
        {
            title: `build from arrays, ${name === 'torus' ? 'triangles' : 'quads'}`,
            why: building,
            ours: 'build',
            ...rate('Mface/s'),
            target: [['cgal', order === 'natural' ? 3 : 4]],
        },
    ],
});

// A row, and the same work as the first of a process, in memory that the system has to clear first.
// Users of a daemon mostly see first runs.
const laterAndFirst = (row) => [
    row,
    { ...row, title: `${row.title}, first run`, fresh: true, target: [['cgal', 1.5]] },
];

// A row whose title ends in `of a list` tells our kernel which edges come next, as delaunay does.
// The other libraries have no such call, so the row is compared with our own edits without this
// call. When edits are made one after another, each waits for memory: the links of a half-edge are
// in four arrays, so each random half-edge costs four cache lines, whereas it would cost one if all
// its links were in one struct. These arrays are what makes traversal fast. A cache line takes 130
// to 150 ns to arrive on the machine of these figures, and 16 are fetched at a time. `work` is what
// an edit takes in nanoseconds where all of the mesh is in the cache.
const waits = (deep, lines, work) => {
    const reads = 10 * Math.round(14 * Math.max(deep, lines / 16));
    return (
        `waits for ${deep} reads, each of them for the one before, of about ${lines} lines: ` +
        `${reads} ns an edit at 140 ns a read, and ${work} of work, less what the processor ` +
        'begins of the next edit meanwhile'
    );
};
const whys = { split: waits(2, 26, 50), flip: waits(4, 40, 33), collapse: waits(4, 70, 71) };

// From some point on, CGAL collapses other edges than our kernel does: cgal_edits.cc says why.
const edit = (title, ours, target, theirs = ours) => ({
    title,
    near: 0.01,
    drawn: theirs === 'collapse',
    ours,
    theirs,
    ...rate('M/s'),
    target: [['cgal', target]],
    why: whys[theirs],
});

const listed = (title, row, target) => ({
    ...edit(title, `${row}_list`, target, row),
    sides: ['plain'],
    target: [['plain', target]],
    why: undefined,
});

const file = (title, ours, target, more = {}) => ({
    title,
    ours,
    ...rate('Mface/s'),
    target,
    near: 1e-6,
    ...more,
});

// The distances are in the unit of the coordinates, in which the torus is 8 wide. The largest
// distance is measured from a million points on each surface to the other surface.
const error = (title, of, more) => ({
    title,
    of,
    unit: 'millionths',
    per: 1e-6,
    less: true,
    whole: true,
    ...more,
});

const farthest =
    'the farthest point is told within a few hundredths: 421 by 250,000 points a side, 441 by a ' +
    "million; CGAL's 439 and 425";

// Rows of memory: the bytes that were allocated on the heap, or the peak of resident memory less
// the resident memory before the row.
const memory = (meter, title, ours, more) => ({
    title: `bytes a face ${title}`,
    ours,
    meter,
    unit: 'bytes',
    per: 1,
    less: true,
    fresh: true,
    runs: 1,
    ...more,
});

// Rows of our program alone, about the mesh and its edits as bytes; the limits for edits come from
// the design of the store.
const stored = (title, ours, unit, per, limit) => ({
    title: `stored: ${title}`,
    ours,
    unit,
    per,
    less: true,
    runs: 3,
    limit,
    guard: true,
});

// Rows of our program alone that compare two threads with one. The target is a speedup of a third,
// the least for which a second thread is worth its cost, unless `more` has another.
const scaling = (input, order, rows, why, { target = 1.3, ...more } = {}) => ({
    part: 'scaling',
    input,
    order,
    sides: ['alone'],
    rows: rows.map(([title, row, unit]) => ({
        title: `two threads: ${title}`,
        ours: `${row}_2`,
        theirs: `${row}_1`,
        ...rate(unit),
        target: [['alone', target]],
        why,
    })),
    ...more,
});

const welding =
    'corners become vertices while they are read: 8 bytes a face more than PLY and OBJ take';

const normals =
    'bound by its instructions, not by memory, where ids are in order: a mesh of 3,200 faces, ' +
    'which is in the cache, takes as long a face';
const scattered = 'the corners of a face are read from anywhere: memory is waited for';

const rings =
    'three reads a half-edge all over the mesh, one of which tells the next: memory is waited ' +
    'for, 44 ns a half-edge, and 1.7 in a mesh of 3,200 faces, which is in the cache';

const scanning =
    'the faces of all half-edges are read, 16 MB in order: 0.95 ns each where nothing else runs, ' +
    '0.64 where 160,000 of them are in the cache, and more where other programs want memory, too';

const parsing =
    'the mesh is built, too, which JSON.parse does not: 18 of 42 ms; the document alone is read ' +
    'at 560 MB/s, five times as fast as by JSON.parse';

const importing =
    'building with its checks is half of it (three fifths of the instructions of PLY, a third of ' +
    'OFF), and a tenth and more is the system clearing fresh pages';

export const parts = [
    kernel('torus', 'natural'),
    kernel('torus', 'shuffled'),
    kernel('grid', 'natural'),
    kernel('grid', 'shuffled'),
    {
        part: 'memory',
        input: 'torus',
        order: 'natural',
        before: ['make_files', 'make_glb', 'make_document'],
        rows: [
            memory('heap', 'at rest, built', 'build', { limit: 68 }),
            memory('peak', 'at most, building', 'build', { limit: 85 }),
            memory('heap', 'at rest, imported', 'import_obj', { limit: 68 }),
            ...['OBJ', 'OFF', 'PLY', 'STL', 'GLB', 'JSON'].map((name) =>
                memory('peak', `at most, importing ${name}`, `import_${name.toLowerCase()}`, {
                    limit: 100,
                    guard: true,
                    why: name === 'STL' ? welding : undefined,
                }),
            ),
            ...['OBJ', 'OFF', 'PLY', 'GLB', 'JSON'].map((name) =>
                memory('peak', `at most, exporting ${name}`, `export_${name.toLowerCase()}`, {
                    limit: 2,
                    guard: true,
                }),
            ),
            // STL export must know how many vertices will be merged before it writes the first
            // byte, so it makes a table of positions.
            memory('peak', 'at most, exporting STL', 'export_stl', { limit: 24, guard: true }),
            {
                ...memory('heap', 'a split, mesh alone', 'split', { target: [['best', 1.5]] }),
                title: 'bytes a split, mesh alone',
                near: 0,
            },
            {
                ...memory('heap', '', 'split_kept', { limit: 1152, guard: true }),
                title: 'bytes a split, with its history',
            },
            {
                ...memory('heap', '', 'split_undone', { limit: 1152, guard: true }),
                title: 'bytes a split that was undone',
            },
        ],
    },
    ...['natural', 'shuffled'].map((order) => ({
        part: 'onering',
        input: 'torus',
        order,
        rows: [
            {
                title: 'sum over one-rings',
                why: order === 'natural' ? undefined : rings,
                ours: 'one_ring',
                ...rate('M half-edges/s'),
                near: 1e-9,
                target: [['openmesh', order === 'natural' ? 2.5 : 2]],
            },
        ],
    })),
    ...['natural', 'shuffled'].map((order) => ({
        part: 'normals',
        input: 'torus',
        order,
        rows: [
            {
                title: 'face normals',
                why: order === 'natural' ? normals : scattered,
                ours: 'face_normals',
                ...rate('Mface/s'),
                near: 1e-9,
                target: [['cgal', 2]],
            },
            {
                // CGAL weights the normals of faces in its own way, so only the time is compared.
                title: 'vertex normals',
                why: order === 'natural' ? normals : scattered,
                ours: 'vertex_normals',
                ...rate('Mvertex/s'),
                near: 1e-2,
                target: [['best', 1.5]],
            },
        ],
    })),
    ...['natural', 'shuffled'].map((order) => ({
        part: 'edits',
        input: 'torus',
        order,
        rows: [
            edit('random edge splits', 'split', 2.5),
            listed('random edge splits, of a list', 'split', 1),
            edit('random edge splits, recorded', 'split_recorded', 1.5, 'split'),
            edit('random flips', 'flip', 2),
            listed('random flips, of a list', 'flip', 1),
            edit('random flips, recorded', 'flip_recorded', 1.5, 'flip'),
            edit('random collapses', 'collapse', 2.5),
            listed('random collapses, of a list', 'collapse', 1),
            edit('random collapses, recorded', 'collapse_recorded', 1.5, 'collapse'),
        ],
    })),
    {
        part: 'loops',
        input: 'holes',
        order: 'natural',
        rows: [
            {
                title: 'boundary loops',
                why: scanning,
                ours: 'loops',
                ...rate('M half-edges/s'),
                target: [['best', 1.5]],
            },
        ],
    },
    ...['natural', 'shuffled'].map((order) => ({
        part: 'components',
        input: 'pieces',
        order,
        rows: [
            {
                title: '64 components',
                ours: 'components',
                ...rate('Mface/s'),
                target: [['best', 1.5]],
            },
        ],
    })),
    ...['natural', 'shuffled'].map((order) => ({
        part: 'compact',
        input: 'torus',
        order,
        rows: [
            {
                title: 'compact after collapses',
                near: 0.01,
                drawn: true,
                ours: 'compact',
                ...rate('Mface/s'),
                target: [['best', 1]],
            },
        ],
    })),
    {
        part: 'files',
        input: 'torus',
        order: 'natural',
        before: ['make_files'],
        rows: [
            file('import OBJ', 'import_obj', [['cgal', 5]]),
            file('import OFF', 'import_off', [['openmesh', 3]], { why: importing }),
            file('import PLY, binary', 'import_ply', [['openmesh', 3]], { why: importing }),
            file('import STL, binary', 'import_stl', [['openmesh', 3]], { runs: 3 }),
            file('export OBJ', 'export_obj', [['openmesh', 2]], { after: 'check_obj' }),
            file('export PLY, binary', 'export_ply', [['openmesh', 1.5]], { after: 'check_ply' }),
        ],
    },
    {
        part: 'subdivide',
        input: 'torus',
        order: 'natural',
        side: 400,
        rows: laterAndFirst({
            title: 'Loop, one step',
            ours: 'loop',
            ...rate('M output faces/s'),
            near: 1e-9,
            target: [['cgal', 2.5]],
            runs: 3,
        }),
    },
    {
        part: 'subdivide',
        input: 'grid',
        order: 'natural',
        side: 400,
        rows: laterAndFirst({
            title: 'Catmull-Clark, one step',
            ours: 'catmull_clark',
            ...rate('M output faces/s'),
            near: 1e-2,
            target: [['cgal', 2.5]],
            runs: 3,
        }),
    },
    {
        part: 'decimate',
        input: 'torus',
        order: 'natural',
        sides: ['openmesh', 'cgal', 'meshoptimizer'],
        rows: [
            {
                title: 'decimate to a tenth',
                why:
                    'the order by cost times error takes a square root an edge, and made the ' +
                    'Hausdorff distance a tenth smaller, by 250,000 points a side',
                ours: 'decimate',
                unit: 's',
                per: 1,
                whole: true,
                less: true,
                near: 1e-2,
                target: [['cgal', 10]],
                runs: 3,
                slow: ['openmesh', 'cgal'],
                errors: [
                    {
                        by: 'decimate_error',
                        rows: [
                            error('its error, root mean square', 'value', {
                                target: [['cgal', 1]],
                            }),
                            error('its error, Hausdorff', 'near', {
                                target: [['cgal', 1]],
                                why: farthest,
                            }),
                            error('points of it where a face turned', 'amount', {
                                unit: '',
                                per: 1,
                                limit: 0,
                            }),
                        ],
                    },
                ],
            },
        ],
    },
    ...remesh,
    ...deform,
    ...fill,
    ...smooth,
    {
        part: 'json',
        input: 'torus',
        order: 'natural',
        side: 360,
        before: ['make_document'],
        sides: ['node'],
        rows: [
            {
                title: 'mesh from a JSON document; JSON.parse',
                why: parsing,
                ours: 'json_read',
                ...rate('MB/s'),
                target: [['node', 4]],
            },
            {
                title: 'JSON document of a mesh; JSON.stringify',
                ours: 'json_print',
                ...rate('MB/s'),
                target: [['node', 1.5]],
            },
        ],
    },
    ...['natural', 'shuffled'].map((order) =>
        scaling(
            'torus',
            order,
            [
                ['build from arrays', 'build', 'Mface/s'],
                ['face normals', 'face_normals', 'Mface/s'],
                ['corner normals', 'corner_normals', 'M half-edges/s'],
            ],
            'ranges are done by both threads, which share the memory',
        ),
    ),
    scaling(
        'torus',
        'natural',
        [
            ['import OBJ', 'import_obj', 'Mface/s'],
            ['import PLY, binary', 'import_ply', 'Mface/s'],
        ],
        'the build inside has two threads, the reading before it one',
        { before: ['make_files'] },
    ),
    scaling(
        'torus',
        'natural',
        [
            ['export OBJ', 'export_obj', 'Mface/s'],
            ['export OFF', 'export_off', 'Mface/s'],
            ['export PLY, text', 'export_ply_text', 'Mface/s'],
            ['export PLY, binary', 'export_ply', 'Mface/s'],
        ],
        'what is written before the first row, and the warnings, are the work of one thread',
        { target: 1.5 },
    ),
    scaling(
        'torus',
        'natural',
        [['decimate to 90 % of the faces', 'decimate', 'Mface/s']],
        'both threads compute the costs of all edges; planes are added and edges collapsed by one',
    ),
    scaling(
        'torus',
        'natural',
        [['Hausdorff distance with means', 'compare', 'Mface/s']],
        'one thread cuts the triangles that hold the farthest point, in the order of their bounds',
        { side: 200 },
    ),
    scaling(
        'torus',
        'natural',
        [['Loop, one step', 'loop', 'M output faces/s']],
        'sums at vertices stay with one thread: their order is part of the result',
        { side: 400 },
    ),
    scaling(
        'grid',
        'natural',
        [['Catmull-Clark', 'catmull_clark', 'M output faces/s']],
        'sums at vertices stay with one thread: their order is part of the result',
        { side: 400 },
    ),
    {
        part: 'stored',
        input: 'torus',
        order: 'natural',
        sides: [],
        rows: [
            stored('bytes a vertex moved', 'stored_move', 'bytes', 1, 68),
            stored('bytes an edge flipped', 'stored_flip', 'bytes', 1, 130),
            stored('bytes a face poked', 'stored_poke', 'bytes', 1, 378),
            stored('bytes an edge split', 'stored_split', 'bytes', 1, 507),
            stored('bytes an edge collapsed', 'stored_collapse', 'bytes', 1, 509),
            stored('bytes a face of a whole mesh', 'content_bytes', 'bytes', 1, 34),
            stored('a split read and applied', 'stored_forward', 'µs', 1e-6, 6),
            stored('a megabyte of mesh written', 'content_write', 'µs', 1e-6, 1300),
            stored('a megabyte of mesh read', 'content_read', 'µs', 1e-6, 2500),
        ],
    },
    ...segment,
    ...compare,
    ...solve,
];
