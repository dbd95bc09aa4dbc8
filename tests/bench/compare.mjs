// compare.mjs - benchmarks the kernel together with its peers (other mesh libraries): every row of
// rows.mjs is run by each program in turn, `--runs` times; the table has medians, spread and
// ratios, and says which rows miss their target.
//
//     node compare.mjs --programs FOLDER [--only build,files] [--runs 5] [--scale 1]
//         [--picture build/growth.svg]
//
// Each program waits for the name of a row (side/side.h), and only one of them works at a time. The
// results that they compute must agree: if they do not, or if a program fails, the exit status is
// 1. A missed target is reported and is no failure. `--scale 0.1` makes inputs of a hundredth of
// the faces, for trying things out.

import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

import { measureGrowth } from './growth.mjs';
import { parts } from './rows.mjs';

const { values: options } = parseArgs({
    options: {
        programs: { type: 'string' },
        only: { type: 'string', default: '' },
        runs: { type: 'string', default: '5' },
        scale: { type: 'string', default: '1' },
        flags: { type: 'string', default: '' },
        'peer-flags': { type: 'string', default: '' },
        picture: { type: 'string', default: 'build/growth.svg' },
    },
});

const names = {
    openmesh: 'OpenMesh',
    cgal: 'CGAL',
    meshoptimizer: 'meshoptimizer',
    eigen: 'Eigen',
    node: 'node',
    alone: 'one thread',
    plain: 'no list',
};
// These rows compare our own program with itself.
const own = ['alone', 'plain'];
const packages = {
    openmesh: 'libopenmesh-dev',
    cgal: 'libcgal-dev',
    meshoptimizer: 'libmeshoptimizer-dev',
    eigen: 'libeigen3-dev',
};
const problems = [];

// One program of the benchmark, started in a folder of its own, or the part that runs in node.
class Side {
    constructor(name, { input, order }, side, folder, env = {}) {
        this.name = name;
        const args = [input, order, String(side), folder];
        const json = fileURLToPath(new URL('peers/json.mjs', import.meta.url));
        const how = { stdio: ['pipe', 'pipe', 'inherit'], env: { ...process.env, ...env } };
        this.child =
            name === 'node'
                ? spawn(process.execPath, [json, ...args], how)
                : spawn(join(options.programs, own.includes(name) ? 'ours' : name), args, how);
        this.lines = createInterface({ input: this.child.stdout })[Symbol.asyncIterator]();
        this.ended = new Promise((resolve) => this.child.on('close', resolve));
        this.child.stdin.on('error', () => {});
    }

    // Returns the measurement of a row; null if the program does not have this row.
    async run(row) {
        this.child.stdin.write(`${row}\n`);
        const { value: line, done } = await this.lines.next();
        if (done) {
            throw new Error(`${this.name} broke at ${row}`);
        }
        if (line === 'unknown') {
            return null;
        }
        const [value, amount, exact, near, system, faults] = line.split(' ');
        const numbers = { value, amount, near, system, faults };
        for (const [name, text] of Object.entries(numbers)) {
            numbers[name] = Number(text);
        }
        return { ...numbers, exact };
    }

    async end() {
        this.child.stdin.end();
        await this.ended;
    }
}

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

function figureOf(row, { value, amount }) {
    if (row.whole) {
        return value / row.per;
    }
    return (row.less ? value / amount : amount / value) / row.per;
}

function agree(row, part, name, ours, theirs) {
    const what = `${row.title}, ${part.order}: ${names[name]}`;
    if (ours.exact !== '-' && theirs.exact !== '-' && ours.exact !== theirs.exact) {
        problems.push(`${what} made another result (${theirs.exact}, ours ${ours.exact})`);
    }
    const apart = Math.abs(ours.near - theirs.near);
    const near = row.drawn ? row.near / Number(options.scale) : row.near;
    if (near > 0 && apart > near * Math.abs(ours.near)) {
        problems.push(`${what} got ${theirs.near}, we ${ours.near}: more than ${near} apart`);
    }
}

// Runs a row once in each program. If the row has a member `after`, the results that are compared
// are those of our own row of that name, which reads what each program has written.
async function round(row, part, start, sides, figures) {
    const results = {};
    const others = row.sides ?? part.sides;
    for (const name of ['ours', ...others]) {
        if (row.slow?.includes(name) && name in figures) {
            continue;
        }
        const side = row.fresh ? start(name) : sides[name];
        const title = name === 'ours' ? row.ours : (row.theirs ?? row.ours);
        const result = await side.run(row.meter ? `${row.meter} ${title}` : title);
        if (row.fresh) {
            await side.end();
        }
        if (result === null) {
            continue;
        }
        figures[name] = [...(figures[name] ?? []), figureOf(row, result)];
        results[name] = row.after ? await sides.ours.run(row.after) : result;
        for (const errors of row.errors ?? []) {
            errors.told[name] ??= await sides.ours.run(errors.by);
        }
    }
    const { ours } = results;
    for (const name of others) {
        if (ours !== undefined && results[name] !== undefined) {
            agree(row, part, name, ours, results[name]);
        }
    }
}

function spreadOf(list) {
    const middle = median(list);
    const widest = Math.max(...list.map((figure) => Math.abs(figure / middle - 1)));
    return `±${Math.round(100 * widest)} %`;
}

const digits = (figure) => figure.toPrecision(3).replace(/e\+?.*/, '');
const shown = (figure) => {
    if (figure === undefined) {
        return '-';
    }
    return figure >= 100 ? figure.toFixed(0) : digits(figure);
};

// Returns how many times better our figure is than that of the other program. A larger figure is
// better, unless the row has `less`.
const ratio = (row, ours, theirs) => (row.less ? theirs / ours : ours / theirs);

// A figure within a twentieth of its target may miss it in another run, so such a row is explained
// like a row that misses its target.
const EDGE = 0.95;

function verdict(row, part, medians) {
    const { ours } = medians;
    if (ours === undefined) {
        return { ratio: '-', target: '', says: 'not there yet' };
    }
    if (row.limit !== undefined) {
        return {
            ratio: '',
            target: `<= ${row.limit}${row.guard ? ' *' : ''}`,
            says: ours <= row.limit ? 'ok' : 'falls short',
            near: ours > EDGE * row.limit,
        };
    }
    if (row.target === undefined) {
        return { ratio: '', target: '', says: '' };
    }
    const [[peer, times]] = row.target;
    const ratios = (row.sides ?? part.sides)
        .filter((name) => name in medians)
        .map((name) => [name, ratio(row, ours, medians[name])]);
    const best = ratios.reduce((a, b) => (b[1] < a[1] ? b : a));
    const [name, reached] = peer === 'best' ? best : ratios.find(([one]) => one === peer);
    return {
        ratio: `${reached > 1000 ? '> 1000' : reached.toFixed(2)} x ${names[name]}`,
        target: `>= ${times}`,
        says: reached >= times ? 'ok' : 'falls short',
        near: EDGE * reached < times,
    };
}

const columns = [
    ['', 40],
    ['order', 9],
    ['unit', 17],
    ['ours', 7],
    ['spread', 8],
    ['OpenMesh', 9],
    ['CGAL', 7],
    ['other', 21],
    ['ratio', 20],
    ['target', 8],
    ['', 0],
];
const print = (cells) =>
    console.log(cells.map((cell, i) => String(cell).padEnd(columns[i][1])).join(' ').trimEnd());

function report(row, part, figures) {
    const medians = Object.fromEntries(
        Object.entries(figures).map(([name, list]) => [name, median(list)]),
    );
    const { ratio: reached, target, says, near } = verdict(row, part, medians);
    const other = ['meshoptimizer', 'eigen', 'node', ...own]
        .filter((name) => name in medians)
        .map((name) => `${names[name]} ${shown(medians[name])}`)
        .join();
    print([
        row.title,
        part.order,
        row.unit,
        shown(medians.ours),
        figures.ours?.length > 1 ? spreadOf(figures.ours) : '',
        shown(medians.openmesh),
        shown(medians.cgal),
        other,
        reached,
        target,
        says,
    ]);
    if ((says === 'falls short' || near) && row.why) {
        console.log(`    ${row.why}`);
    }
}

async function runPart(part, folder) {
    part.sides ??= ['openmesh', 'cgal'];
    const usual = part.input === 'grid' || part.input === 'holes' ? 1000 : 724;
    const side = Math.max(8, Math.round((part.side ?? usual) * Number(options.scale)));
    const start = (name) => new Side(name, part, side, folder);
    const sides = {};
    const others = part.rows.flatMap((row) => row.sides ?? part.sides);
    for (const name of new Set(['ours', ...others])) {
        sides[name] = start(name);
    }
    for (const row of part.before ?? []) {
        await sides.ours.run(row);
    }
    for (const row of part.rows) {
        if (row.note) {
            console.log(`${row.title}: ${row.note}`);
            continue;
        }
        const figures = {};
        for (const errors of row.errors ?? []) {
            errors.told = {};
        }
        const runs = Math.min(row.runs ?? Infinity, Number(options.runs));
        for (let i = 0; i < runs; i++) {
            await round(row, part, start, sides, figures);
        }
        report(row, part, figures);
        for (const { rows, told } of row.errors ?? []) {
            for (const error of rows) {
                const all = Object.entries(told);
                const figure = ([name, one]) => [name, [one[error.of] / error.per]];
                report(error, part, Object.fromEntries(all.map(figure)));
            }
        }
    }
    for (const one of Object.values(sides)) {
        await one.end();
    }
}

function version(name) {
    return execFileSync('dpkg-query', ['-W', '-f', '${Version}', packages[name]], {
        encoding: 'utf8',
    });
}

function header() {
    const [cpu] = os.cpus();
    const system = readFileSync('/etc/os-release', 'utf8').match(/^PRETTY_NAME="(.*)"/m);
    const compiler = execFileSync('gcc', ['-dumpfullversion'], { encoding: 'utf8' }).trim();
    const versions = Object.keys(packages).map((name) => `${names[name]} ${version(name)}`);
    console.log(
        `${new Date().toISOString().slice(0, 10)}, ${os.cpus().length} x ${cpu.model}, ` +
            `${system?.[1] ?? os.type()}, gcc ${compiler}, node ${process.versions.node}\n` +
            `${versions.join(', ')}\n` +
            `ours:  ${options.flags}\npeers: ${options['peer-flags']}\n` +
            `Medians of ${options.runs} runs or fewer, in turn; processor time of one thread, ` +
            `but for two\nthreads beside one (scaling), whose time is the clock's.` +
            `${options.scale === '1' ? '' : ` Inputs scaled by ${options.scale}.`}\n` +
            'Files are read from and written to memory; text is exported so that doubles ' +
            'read back.\nA target with * is a guard of our own, near what is measured.\n',
    );
}

const only = options.only.split(',').filter(Boolean);
const known = [...new Set(parts.map(({ part }) => part)), 'growth'];
const unknown = only.filter((name) => !known.includes(name));
if (unknown.length > 0 || !options.programs) {
    console.error(`compare.mjs: no part ${unknown.join(', ')}; there are ${known.join(', ')}`);
    process.exit(2);
}

const memory = '/dev/shm';
const folder = mkdtempSync(join(existsSync(memory) ? memory : os.tmpdir(), 'bench-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
const began = performance.now();
header();
if (only.some((name) => name !== 'growth') || only.length === 0) {
    print(columns.map(([title]) => title));
}
for (const part of parts) {
    if (only.length === 0 || only.includes(part.part)) {
        await runPart(part, folder);
    }
}
if (only.length === 0 || only.includes('growth')) {
    const start = (part, side, env) => new Side('ours', part, side, folder, env);
    await measureGrowth(start, Number(options.scale), options.picture);
}
console.log(`\n${((performance.now() - began) / 1000).toFixed(0)} s in all`);
for (const problem of new Set(problems)) {
    console.log(`DISAGREE ${problem}`);
}
process.exitCode = problems.length > 0 ? 1 : 0;
