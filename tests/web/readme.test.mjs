// readme.test.mjs - what README.md tells its readers to paste works, with the daemon's address in
// place of the usual one, and prints what it says.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { promisify } from 'node:util';

import { startDaemon } from './daemon.mjs';

const readme = await readFile(new URL('../../README.md', import.meta.url), 'utf8');

// What the lines of a block may print in all: some thirty lines of a terminal.
const MOST_PRINTED = 3000;

// The code blocks of a language, with another address.
function blocks(language, url) {
    const found = readme.matchAll(new RegExp(`^\`\`\`${language}\n(.*?)^\`\`\`$`, 'gms'));
    return [...found].map(([, code]) => code.replaceAll('http://127.0.0.1:8080', url));
}

async function run(program, words) {
    const { stdout } = await promisify(execFile)(program, words);
    return stdout;
}

// The shell lines that have this in them.
function shellWith(text, url) {
    const found = blocks('sh', url).filter((code) => code.includes(text));
    assert.equal(found.length, 1, text);
    return found[0];
}

// What each curl of a block is answered: a line each.
async function runCurls(block) {
    const printed = await run('sh', ['-ec', block]);
    return printed.trim().split('\n');
}

const parsed = (lines) => lines.map((line) => JSON.parse(line));

// The comment at the end of the line that prints.
function promised(code, mark) {
    const [, text] = new RegExp(`^(?:print|console\\.log)\\(.*${mark} (.*)$`, 'm').exec(code);
    return text;
}

test('the curl lines work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const block = shellWith('halfedges/0', url);
    const lines = block.replaceAll('\\\n', '').split('\n');
    const commands = lines.filter((line) => line !== '' && !line.startsWith('#'));
    assert.equal(commands.length, 7);
    const answers = [];
    for (const command of commands) {
        assert.match(command, /^curl /);
        const printed = await run('sh', ['-c', `${command} -sS --fail-with-body`]);
        assert.match(printed, /\n$/);
        answers.push(JSON.parse(printed));
    }
    const [made, halfedge, faces, edited, undone, history, before] = answers;
    assert.equal(made.counts.faces, 2);
    assert.deepEqual(Object.keys(halfedge).slice(1, 8), [
        ...['twin', 'next', 'prev', 'origin', 'target', 'edge', 'face'],
    ]);
    assert.deepEqual(faces.ids.sort(), [0, 1]);
    const { created, deleted } = edited;
    const more = (kind) => created[kind].length - deleted[kind].length;
    assert.deepEqual(['vertices', 'edges', 'faces'].map(more), [1, 3, 2]);
    assert.equal(undone.redo, 1);
    assert.deepEqual(history.entries.map((entry) => entry.action), ['undo', 'edit']);
    assert.equal(before.revision, 2);
    assert.equal(before.items.length, made.counts.vertices + 1);
});

test('the lines about repairs work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const [refused, made] = parsed(await runCurls(shellWith('repair=split', url)));
    assert.equal(refused.status, 422);
    assert.deepEqual(refused.repair, ['split']);
    assert.equal(made.import.repairs[0].count, 2);
});

test('the lines about jobs work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const lines = await runCurls(shellWith('respond-async', url));
    assert.match(lines.at(-2), /^"state":"done","phase":/);
    const last = JSON.parse(lines.at(-1));
    assert.equal(last.state, 'done');
    assert.equal(last.result.counts.faces, 512 * 512);
});

test('the lines about finer and coarser meshes work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const block = shellWith('"decimate"', url);
    const [made, subdivided, decimated] = await runCurls(block);
    assert.equal(JSON.parse(made).counts.faces, 320);
    assert.deepEqual(JSON.parse(subdivided).results[0].faces, [1280, 5120]);
    const [, beginning] = /# ("stop":.*)\.\.\.$/m.exec(block);
    assert.ok(decimated.startsWith(beginning), decimated);
    assert.equal((await (await fetch(`${url}/v1/meshes/ball`)).json()).counts.faces, 500);
});

test('no line floods a terminal, ends without a line end or changes a sample', async (t) => {
    const { url } = await startDaemon(t, '--samples');
    const list = async () => (await (await fetch(`${url}/v1/meshes`)).json()).items;
    const samples = await list();
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-readme-'));
    t.after(() => rm(folder, { recursive: true }));
    const pasted = blocks('sh', url).filter((code) => code.includes(url) && /^curl /m.test(code));
    assert.ok(pasted.length >= 6);
    for (const block of pasted) {
        const printed = await run('sh', ['-ec', `cd ${folder}\n${block}`]);
        assert.ok(printed.length > 0 && printed.length < MOST_PRINTED, block);
        assert.match(printed, /\n$/, block);
        assert.doesNotMatch(printed, /\}\{/, block);
    }
    const now = new Map((await list()).map((mesh) => [mesh.id, mesh]));
    for (const sample of samples) {
        assert.deepEqual(now.get(sample.id), sample);
    }
});

test('the lines about codings work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const block = shellWith('Content-Encoding: gzip', url);
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-readme-'));
    t.after(() => rm(folder, { recursive: true }));
    await fetch(`${url}/v1/meshes/kite`, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: '{"shape":"cube"}',
    });
    const printed = await run('sh', ['-ec', `cd ${folder}\n${block}`]);
    assert.equal(JSON.parse(printed).counts.faces, 6);
});

test('the Python lines work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const [code, ...others] = blocks('python', url);
    assert.equal(others.length, 0);
    assert.equal((await run('python3', ['-c', code])).trim(), promised(code, '#'));
});

test('the JavaScript lines work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const [code, ...others] = blocks('js', url);
    assert.equal(others.length, 0);
    const printed = await run(process.execPath, ['--input-type=module', '--eval', code]);
    assert.equal(printed.trim(), promised(code, '//'));
});

test('each file and make target it names is there', async () => {
    const makefile = await readFile(new URL('../../Makefile', import.meta.url), 'utf8');
    for (const [, target] of readme.matchAll(/`make ([a-z-]+)/g)) {
        assert.match(makefile, new RegExp(`^${target}:`, 'm'), target);
    }
    // And the table, which `make fresh` tries, has each target but those that only serve others.
    const [table] = /^\| command \|.*?\n\n/ms.exec(readme);
    const named = new Set([...table.matchAll(/`(?:make )?([a-z-]+)/g)].map(([, name]) => name));
    const parts = ['help', 'page', 'programs', 'ready', 'clean'];
    for (const [, target] of makefile.matchAll(/^([a-z-]+):.*##/gm)) {
        assert.ok(named.has(target === 'all' ? 'make' : target) || parts.includes(target), target);
    }
    for (const [, link] of readme.matchAll(/\]\(([^):]+)\)/g)) {
        await readFile(new URL(`../../${link}`, import.meta.url));
    }
});
