// growth.mjs - how the cost of operations grows: nanoseconds per element on meshes of 10k, 100k, 1M
// and 10M faces, as tables and as a picture, build/growth.svg. The picture in the README is
// tests/bench/growth.svg. The rows are those of tests/bench/ours on the bumpy torus.
//
// The algorithms of the kernel cost the same per element on every size of mesh. The lines bend only
// where the mesh outgrows a cache of the machine or where its memory pages cost more. The three
// tables after the first show the cause of each bend. The figures below belong to the picture: an
// EPYC with 1 MiB of L2 cache per core and 32 MiB of L3, while other programs ran.
//
// Caches. A face takes 66 bytes, so 10k faces are 0.7 MB and fit into L2, 100k are 7 MB and fit
// into L3, 1M and 10M are 66 MB and 660 MB and fit into neither. The row `random read` reads words
// at random places of a block of that size; its time rises only where the block outgrows a cache:
// 1.1, 1.8, 8.9 and 9.7 ns. Flips, collapses, decimation and everything with shuffled ids read and
// write a few dozen random places per element, so their times rise in the same way: flips 54, 94,
// 364, 394 ns, collapses 140, 241, 699, 820. One-rings in natural order read forward, which the
// processor prefetches, and stay flat: 1.0 to 1.2 ns. So do normals, 9.1 to 9.6.
//
// Address translation. Arrays of 4 MiB and more request huge pages; the arrays of a mesh reach that
// size between 100k and 1M faces. Without huge pages, at 10M faces a random read costs 12 ns
// instead of 9.7, building shuffled faces 266 instead of 235, their one-rings 51 instead of 43,
// their normals 93 instead of 84.
//
// Pages that are touched for the first time. Operations that make new arrays (build, split,
// compact, Loop, import) wait while the system finds and clears their pages. Build rises from 10k
// to 100k (56 to 67 ns) because its arrays of over 1 MiB become mappings of their own: 1,934 small
// pages, one per 52 faces. It falls at 1M (52 ns), where huge pages leave one page per 190 faces.
// Loop (33, 39, 24) and import of OBJ (134, 223, 176) behave in the same way. At 10M the system
// takes the greater part of the time of compact (129 of 158 ns) and of Loop, which makes 40M faces
// (112 of 128). It is not the clearing that takes so long: a compact of 10M faces measured
// separately took 217 ns with huge pages and 69 without, 44 of them in the system, for 180,950
// small pages in place of 6,188. On a machine where blocks of 2 MiB are hard to find, huge pages
// cost writers as much as they give readers.
//
// Import of OBJ bends at 10M because of new pages, too (80 of 216 ns): it also makes lists of
// vertices and faces before the mesh. Splits have both causes: random places, and arrays that grow
// by half when they are full (252 of 824).

import { readFileSync, writeFileSync, mkdirSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';

import { plot } from './plot.mjs';

// The sizes of the torus, each with the number of runs of a row. A torus with the side n has 2 n *
// n faces.
const SIZES = [
    { side: 71, runs: 15 },
    { side: 224, runs: 7 },
    { side: 707, runs: 3 },
    { side: 2236, runs: 1 },
];

// Each entry is a line of the picture: its row in tests/bench/ours, its title and its kind of
// element. Two lines of one colour are the same row in natural and in shuffled order.
const NATURAL = [
    ['gather', 'random read', 'read', '#8a8a8a'],
    ['build', 'build', 'face', '#2f7fc1'],
    ['one_ring', 'one-ring', 'half-edge', '#2a9d5c'],
    ['face_normals', 'face normals', 'face', '#c2448c'],
    ['check', 'check', 'face', '#7a9a1f'],
    ['split', 'edge split', 'edit', '#d1741f'],
    ['flip', 'edge flip', 'edit', '#b8860b'],
    ['collapse', 'edge collapse', 'edit', '#d04040'],
    ['compact', 'compact', 'face', '#7d5fc4'],
    ['loop', 'Loop subdivision', 'output face', '#138f9b'],
    ['decimate', 'decimate to a tenth', 'face', '#a0522d'],
    ['export_obj', 'export OBJ', 'face', '#5c7fa8'],
    ['check_obj', 'import OBJ', 'face', '#4a6fd8'],
];
const SHUFFLED = ['build', 'one_ring', 'face_normals'];
// The rows that show the cost of pages: those whose elements are read in random order.
const BY_PAGES = { natural: ['gather', 'split', 'loop'], shuffled: SHUFFLED };
// A shorter measurement says nothing about the time spent in the system, because the system counts
// this time in ticks.
const LEAST_SECONDS = 0.04;

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

// Returns the nanoseconds per element, how many of these were spent in the system, and the number
// of page faults.
async function time(side, row, runs) {
    const list = [];
    for (let i = 0; i < runs; i++) {
        const { value, amount, system, faults } = await side.run(row);
        const known = value >= LEAST_SECONDS;
        list.push({
            time: (1e9 * value) / amount,
            system: known ? (1e9 * system) / amount : NaN,
            faults,
        });
    }
    return Object.fromEntries(
        ['time', 'system', 'faults'].map((name) => [name, median(list.map((one) => one[name]))]),
    );
}

async function measure(start, size, order, rows, env) {
    const side = start({ input: 'torus', order }, size.side, env);
    const found = {};
    for (const row of rows) {
        found[row] = await time(side, row, size.runs);
    }
    await side.end();
    return found;
}

const shown = (number) => {
    if (Number.isNaN(number)) {
        return '-';
    }
    return number >= 100 ? number.toFixed(0) : number.toPrecision(3);
};
const WIDTHS = [22, 10, 13];

function table(title, names, lines, cell) {
    console.log(`\n${title}`);
    const head = ['', 'order', 'element', ...names];
    const print = (cells) =>
        console.log(
            cells
                .map((text, i) => String(text).padEnd(WIDTHS[i] ?? 10))
                .join(' ')
                .trimEnd(),
        );
    print(head);
    for (const line of lines) {
        print([line.title, line.order, line.element, ...names.map((name, i) => cell(line, i))]);
    }
}

function machine() {
    const [cpu] = os.cpus();
    const cache = (index) => {
        const folder = `/sys/devices/system/cpu/cpu0/cache/index${index}`;
        try {
            return readFileSync(`${folder}/size`, 'utf8').trim();
        } catch {
            return '?';
        }
    };
    const date = new Date().toISOString().slice(0, 10);
    return `${date}, ${cpu.model}, L1d ${cache(0)}, L2 ${cache(2)}, L3 ${cache(3)}`;
}

export async function measureGrowth(start, scale, picture) {
    const sizes = SIZES.map((size) => ({
        ...size,
        side: Math.max(8, Math.round(size.side * scale)),
    }));
    const names = sizes.map(({ side }) =>
        new Intl.NumberFormat('en', { notation: 'compact' }).format(2 * side * side),
    );
    const orders = { natural: NATURAL.map(([row]) => row), shuffled: SHUFFLED };
    const lines = Object.entries(orders).flatMap(([order, rows]) =>
        rows.map((row) => {
            const [, title, element, colour] = NATURAL.find(([name]) => name === row);
            return { row, order, title, element, colour, found: [], small: [] };
        }),
    );
    for (const size of sizes) {
        for (const [order, rows] of Object.entries(orders)) {
            const found = await measure(start, size, order, rows, {});
            const env = { BENCH_SMALL_PAGES: '1' };
            const small = await measure(start, size, order, BY_PAGES[order], env);
            for (const line of lines.filter((one) => one.order === order)) {
                line.found.push(found[line.row]);
                line.small.push(small[line.row]);
            }
        }
    }
    const show = (title, some, cell) => table(title, names, some, cell);
    show('How cost grows: nanoseconds an element', lines, ({ found }, i) => shown(found[i].time));
    show('of which in the system', lines, ({ found }, i) => shown(found[i].system));
    show('pages that had to be found', lines, ({ found }, i) => found[i].faults);
    show(
        'without huge pages',
        lines.filter(({ small }) => small[0] !== undefined),
        ({ small }, i) => shown(small[i].time),
    );
    mkdirSync(path.dirname(picture), { recursive: true });
    writeFileSync(
        picture,
        plot({
            sizes: sizes.map(({ side }) => 2 * side * side),
            names,
            caption: machine(),
            lines: lines.map(({ title, order, element, colour, found }) => ({
                title: `${title}${order === 'shuffled' ? ', shuffled' : ''} / ${element}`,
                colour,
                dashed: order === 'shuffled',
                values: found.map((one) => one.time),
            })),
        }),
    );
    console.log(`\n${machine()}: ${picture}`);
}
