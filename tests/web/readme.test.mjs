// readme.test.mjs - tests that the commands in README.md and api/GUIDE.md work, with the address of
// the test's daemon in place of the one on these pages, and print what the pages say.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { promisify } from 'node:util';

import { program, startDaemon } from './daemon.mjs';

const read = (name) => readFile(new URL(`../../${name}`, import.meta.url), 'utf8');
const readme = await read('README.md');
const guide = await read('api/GUIDE.md');

// The commands of a code block may print at most this many characters, about thirty lines of a
// terminal.
const MOST_PRINTED = 3000;

// Returns the code blocks of a language on both pages, with the address of the test's daemon.
function blocks(language, url) {
    const found = (readme + guide).matchAll(new RegExp(`^\`\`\`${language}\n(.*?)^\`\`\`$`, 'gms'));
    return [...found].map(([, code]) => code.replaceAll('http://127.0.0.1:8080', url));
}

async function run(program, words) {
    const { stdout } = await promisify(execFile)(program, words);
    return stdout;
}

// Returns the block of shell commands that contains a text; there must be exactly one.
function shellWith(text, url) {
    const found = blocks('sh', url).filter((code) => code.includes(text));
    assert.equal(found.length, 1, text);
    return found[0];
}

// Runs a block of shell commands; returns the lines that they print, one for each curl.
async function runCurls(block) {
    const printed = await run('sh', ['-ec', block]);
    return printed.trim().split('\n');
}

const parsed = (lines) => lines.map((line) => JSON.parse(line));

// Returns the comment at the end of the code line that prints, which promises what is printed.
function promised(code, mark) {
    const [, text] = new RegExp(`^(?:print|console\\.log)\\(.*${mark} (.*)$`, 'm').exec(code);
    return text;
}

// Returns the commands of a block, as {line, promised}; `promised` is the beginning of the answer,
// which the page gives in a comment after the command.
function commandsOf(block) {
    const lines = block.replaceAll('\\\n', '').split('\n');
    const commands = [];
    for (const line of lines.filter((text) => text !== '')) {
        if (line.startsWith('curl ')) {
            commands.push({ line, promised: '' });
        } else if (line.startsWith('# {')) {
            commands.at(-1).promised = line.slice(2).replace(/\.\.\.$/, '');
        }
    }
    return commands;
}

// Runs each command of a block, checks that its answer begins as the page says, and returns all
// answers.
async function answersOf(block) {
    const answers = [];
    for (const { line, promised } of commandsOf(block)) {
        const printed = await run('sh', ['-c', `${line} -sS --fail-with-body`]);
        assert.match(printed, /\n$/);
        assert.ok(printed.startsWith(promised), `${line}: ${printed}`);
        answers.push(JSON.parse(printed));
    }
    return answers;
}

test('the quick start answers what it shows, also after the daemon was killed', async (t) => {
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-readme-'));
    t.after(() => rm(folder, { recursive: true }));
    const store = ['--store', `sqlite:${folder}/store`];
    const { url, stop } = await startDaemon(t, ...store);
    const answers = await answersOf(shellWith('halfedges/0', url));
    assert.equal(answers.length, 5);
    const [, halfedge, , { created, deleted }] = answers;
    assert.deepEqual(Object.keys(halfedge).slice(1, 8), [
        ...['twin', 'next', 'prev', 'origin', 'target', 'edge', 'face'],
    ]);
    const more = (kind) => created[kind].length - deleted[kind].length;
    assert.deepEqual(['vertices', 'edges', 'faces'].map(more), [1, 3, 2]);
    await stop('SIGKILL');
    const again = await startDaemon(t, ...store);
    const [redone] = await answersOf(shellWith('/redo', again.url));
    assert.equal(redone.redo, 0);
});

test('each answer that the README shows is tested', () => {
    const shown = readme.match(/^# \{/gm).length;
    const tested = blocks('sh', '').flatMap(commandsOf).filter(({ promised }) => promised !== '');
    assert.equal(tested.length, shown);
});

test('the lines about shapes, files, history and questions work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-readme-'));
    t.after(() => rm(folder, { recursive: true }));
    const files = await runCurls(`cd ${folder}\n${shellWith('ball-again', url)}`);
    const [ball, again] = parsed(files);
    assert.equal(again.counts.faces, ball.counts.faces);
    const lines = await runCurls(shellWith('"edge":2}', url));
    const [, , undone, history, before] = parsed(lines);
    assert.equal(undone.redo, 1);
    assert.deepEqual(history.entries.map((entry) => entry.action), ['undo', 'edit']);
    assert.equal(before.revision, 2);
    assert.equal(before.items.length, 9);
    const [{ results }] = parsed(await runCurls(shellWith('"queries"', url)));
    assert.equal(results.length, 4);
    assert.equal(results.filter((result) => 'problem' in result).length, 0);
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

test('the lines about sets work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const block = shellWith('"into":"lid"', url);
    const [made, lid, rim, same] = await runCurls(block);
    assert.equal(JSON.parse(made).counts.faces, 26);
    assert.equal(lid, '"selected":1,"added":1,"removed":0');
    assert.ok(block.includes(`# ${rim}`), rim);
    assert.equal(same, '"selected":1,"added":0,"removed":0');
    const patches = shellWith('"op":"segment"', url);
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-readme-'));
    t.after(() => rm(folder, { recursive: true }));
    const [found, status] = await runCurls(`cd ${folder}\n${patches}`);
    assert.ok(patches.includes(`# ${found}`), found);
    assert.equal(status, '200');
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

test('the lines about compressed bodies work as pasted', async (t) => {
    const { url } = await startDaemon(t);
    const block = shellWith('Content-Encoding: gzip', url);
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-readme-'));
    t.after(() => rm(folder, { recursive: true }));
    const [made, sent] = parsed(await runCurls(`cd ${folder}\n${block}`));
    assert.equal(sent.counts.faces, made.counts.faces);
});

test('the lines about tokens work as pasted', async (t) => {
    const folder = await mkdtemp(path.join(tmpdir(), 'hedge-readme-'));
    t.after(() => rm(folder, { recursive: true }));
    const [token, line] = (await run(program, ['--new-token', 'alice', 'write'])).split('\n');
    await writeFile(path.join(folder, 'tokens'), line);
    const { url } = await startDaemon(t, '--tokens', path.join(folder, 'tokens'));
    const block = shellWith('/v1/tickets', url);
    const [who, , ticket] = parsed(await runCurls(block.replace('hedge_...', token)));
    assert.deepEqual(who, { name: 'alice', role: 'write', prefixes: [], expires: null });
    const file = await fetch(`${url}${ticket.path}`);
    assert.equal(file.status, 200);
    assert.match(await file.text(), /^v /m);
    assert.equal((await fetch(`${url}${ticket.path}`)).status, 401);
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

// Returns the headings of a page in the form in which links name them: "Live updates" becomes
// live-updates.
const anchorsOf = (text) =>
    [...text.matchAll(/^## (.*)$/gm)].map(([, title]) => title.toLowerCase().replaceAll(' ', '-'));

test('each file, heading and make target they name is there', async () => {
    const makefile = await read('Makefile');
    for (const [, target] of readme.matchAll(/`make ([a-z-]+)/g)) {
        assert.match(makefile, new RegExp(`^${target}:`, 'm'), target);
    }
    // The table of commands must have every target of the Makefile, except those that only serve
    // other targets. `make fresh` runs the commands of the table.
    const [table] = /^\| command \|.*?\n\n/ms.exec(readme);
    const named = new Set([...table.matchAll(/`(?:make )?([a-z-]+)/g)].map(([, name]) => name));
    const parts = ['help', 'page', 'programs', 'ready', 'clean'];
    for (const [, target] of makefile.matchAll(/^([a-z-]+):.*##/gm)) {
        assert.ok(named.has(target === 'all' ? 'make' : target) || parts.includes(target), target);
    }
    for (const [text, folder] of [
        [readme, ''],
        [guide, 'api/'],
        [await read('tests/bench/README.md'), 'tests/bench/'],
    ]) {
        for (const [, file, , anchor] of text.matchAll(/\]\(([^):#]*)(#([^)]*))?\)/g)) {
            const linked = file === '' ? text : await read(folder + file);
            assert.ok(anchor === undefined || anchorsOf(linked).includes(anchor), anchor);
        }
    }
});

test('the README is a page of at most 140 lines', () => {
    assert.ok(readme.split('\n').length - 1 <= 140);
});
