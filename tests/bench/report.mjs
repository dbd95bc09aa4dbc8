// report.mjs - writes down what a benchmark printed: its section of tests/bench/README.md and, for
// `make bench`, six rows of the table in README.md. `make report` calls it after each benchmark.
//
//     node report.mjs NAME COMMAND < OUTPUT
//
// NAME is one of the sections below, COMMAND is what was run. Pictures that the run left in build/
// are copied beside the page.

import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, readFileSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import { fileURLToPath } from 'node:url';

const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const page = here('README.md');
const root = here('../../README.md');

// The sections in the order of the page: what each benchmark is about, and the picture that it
// leaves in build/.
const sections = {
    bench: {
        about:
            'The kernel beside OpenMesh, CGAL, meshoptimizer and Eigen, all from Debian: the same inputs, in ' +
            'turn, with results that must agree. A row that falls short of its target says why.',
        picture: ['growth.svg', 'Nanoseconds an element on meshes of 10 thousand to 10 million faces'],
    },
    'bench-reshape': {
        about:
            'Remeshing, smoothing, filling, deforming, comparing, segments and linear systems beside CGAL ' +
            'and Eigen: the same inputs, in turn, and the same measures of the results. A row that falls ' +
            'short of its target says why.',
    },
    'bench-http': {
        about: 'Requests beside a bare libmicrohttpd program that sends the same bytes in the same run.',
    },
    'bench-store': {
        about: 'Durable edits beside the same bytes written and synced, and beside memory alone.',
    },
    'bench-events': { about: 'A thousand listeners: memory, and the time until all have an event.' },
    'bench-slow': { about: 'A thousand clients that read slowly: what other clients wait for.' },
    'bench-flood': {
        about: 'Clients above their rate beside clients within theirs: what the latter wait for.',
    },
    'bench-large': { about: 'A million quads through the daemon.' },
    'bench-space': {
        about: 'Rays, nearest points, intersections, curvature, triangulation: our figures alone.',
    },
    soak: {
        about: 'Everything that clients do: is the memory of the daemon flat?',
        picture: ['soak.svg', 'Memory of the daemon over the time of the soak'],
    },
};

// The rows of `make bench` that README.md shows, because a user of a mesh library would look for
// these first.
const chosen = [
    'build from arrays, triangles',
    'sum over one-rings',
    'random edge splits',
    'random collapses',
    'import OBJ',
    'Loop, one step',
];
const from = '<!-- Written by tests/bench/report.mjs from here -->\n';
const to = '<!-- to here -->';

function machine() {
    const [cpu] = os.cpus();
    const [, system] = /^PRETTY_NAME="(.*)"/m.exec(readFileSync('/etc/os-release', 'utf8'));
    return `${os.cpus().length} x ${cpu.model}, ${system}`;
}

// Returns what was measured: the commit, or the version if git is missing or the folder is not a
// repository of git.
function state() {
    const git = (...words) => execFileSync('git', words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }).trim();
    try {
        return `commit ${git('rev-parse', '--short=10', 'HEAD')}${git('status', '--porcelain', '-uno') ? '+' : ''}`;
    } catch {
        const [, version] = /SRV_VERSION "(.*)"/.exec(readFileSync(here('../../server/version.h'), 'utf8'));
        return `version ${version}`;
    }
}

// Returns the text of each section that the page has, by name.
function readPage() {
    const text = existsSync(page) ? readFileSync(page, 'utf8') : '';
    const parts = text.split(/^## /m).slice(1);
    return new Map(parts.map((part) => [part.slice(0, part.indexOf('\n')), `## ${part.trimEnd()}\n`]));
}

function writePage(texts) {
    const intro =
        '# What the benchmarks printed\n\n' +
        'Each section was written by `make report` after the command it names had run, with the date, the ' +
        'machine\nand the commit. Nothing is edited by hand.\n';
    const inOrder = Object.keys(sections).flatMap((name) => texts.get(name) ?? []);
    writeFileSync(page, [intro, ...inOrder].join('\n'));
}

function section(name, command, printed) {
    const { about, picture } = sections[name];
    const day = new Date().toISOString().slice(0, 10);
    const lines = [`## ${name}`, '', about, '', `${day}, ${machine()}, ${state()}, \`${command}\`:`];
    lines.push('', '```', printed.trim().replaceAll(/^DONE .*\n/gm, ''), '```');
    const made = picture && `build/${picture[0]}`;
    if (made && existsSync(made)) {
        copyFileSync(made, here(picture[0]));
    }
    if (picture && existsSync(here(picture[0]))) {
        lines.push('', `![${picture[1]}](${picture[0]})`);
    }
    return `${lines.join('\n')}\n`;
}

// Returns rows of a Markdown table, one for each title in `chosen`, from what compare.mjs printed.
function rowsOf(printed) {
    return chosen.flatMap((title) => {
        const row = printed.split('\n').find((line) => line.startsWith(title.padEnd(41) + 'natural'));
        const cells = row?.slice(41).split(/ {2,}|(?<=%) /);
        const [, unit, ours] = cells ?? [];
        const at = (column, width) => row.slice(column, column + width).trim() || '-';
        return row ? [`| ${title} | ${unit} | ${ours} | ${at(85, 9)} | ${at(95, 7)} |`] : [];
    });
}

function writeRows(printed) {
    const rows = rowsOf(printed);
    const text = readFileSync(root, 'utf8');
    const begin = text.indexOf(from) + from.length;
    const end = text.indexOf(to);
    if (rows.length < chosen.length || begin < from.length || end < begin) {
        return; // a part of the benchmark alone
    }
    const table = ['| one thread, a million faces | unit | hedge | OpenMesh | CGAL |', '|---|---|---|---|---|', ...rows];
    writeFileSync(root, `${text.slice(0, begin)}${table.join('\n')}\n${text.slice(end)}`);
}

const [name, command] = process.argv.slice(2);
if (!(name in sections) || !command) {
    console.error(`report.mjs: NAME is one of ${Object.keys(sections).join(', ')}, then the COMMAND`);
    process.exit(2);
}
const printed = readFileSync(0, 'utf8');
const texts = readPage();
texts.set(name, section(name, command, printed));
writePage(texts);
if (name === 'bench') {
    writeRows(printed);
}
