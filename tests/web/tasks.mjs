// tasks.mjs - five tasks that visitors of the page have, done by clicks and keys only, as a person does
// them. tasks.test.mjs checks how many clicks they need and what they bring about, measure.mjs prints
// how long they take.
//
// A task is {name, most, prepare, run, check}: prepare(daemon) makes what exists before the visitor
// comes, and returns {mesh, ...}; run(page, hand, context) does the task; check(context) fails if the
// server does not have the result; `most` is how many clicks the task may need.

import assert from 'node:assert/strict';
import { once } from 'node:events';
import { readFile } from 'node:fs/promises';
import http from 'node:http';

import { projector, waitForFrame, waitForTold } from './browser.mjs';
import { get, getAll, post } from './daemon.mjs';

const DAY = 24 * 60 * 60 * 1000;

// What a visitor does, with the number of clicks and of keys.
export class Hand {
    clicks = 0;
    keys = 0;
    #page;

    constructor(page) {
        this.#page = page;
    }

    async click(locator, options) {
        this.clicks += 1;
        await locator.click(options);
    }

    // Chooses in a list that opens: one click opens the list, the other one chooses.
    async choose(locator, value) {
        this.clicks += 2;
        await locator.selectOption(value);
    }

    async press(key) {
        this.keys += 1;
        await this.#page.keyboard.press(key);
    }

    // Types where the focus is.
    async type(text) {
        this.keys += text.length;
        await this.#page.keyboard.type(text);
    }
}

const button = (within, name) => within.getByRole('button', { name, exact: true });

// Returns a binary STL file of triangles, each of three points.
function stlOf(triangles) {
    const bytes = Buffer.alloc(84 + 50 * triangles.length);
    bytes.writeUInt32LE(triangles.length, 80);
    for (const [i, triangle] of triangles.entries()) {
        triangle.flat().forEach((value, j) => bytes.writeFloatLE(value, 84 + 50 * i + 12 + 4 * j));
    }
    return bytes;
}

// Returns the triangles of a ball, each of three points: an octahedron whose triangles were divided
// into four twice.
function ballOf() {
    const [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const minus = (point) => point.map((value) => -value);
    const halves = [[x, y], [y, minus(x)], [minus(x), minus(y)], [minus(y), x]];
    const eight = halves.flatMap(([a, b]) => [[a, b, z], [b, a, minus(z)]]);
    const between = (a, b) => {
        const sum = a.map((value, i) => value + b[i]);
        return sum.map((value) => value / Math.hypot(...sum));
    };
    const divide = ([a, b, c]) => {
        const [ab, bc, ca] = [between(a, b), between(b, c), between(c, a)];
        return [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
    };
    return eight.flatMap(divide).flatMap(divide);
}

// Uploads a file by the button of the page; the dialog of the operating system is not the page's.
async function upload(page, hand, file) {
    const [chooser] = await Promise.all([
        page.waitForEvent('filechooser'),
        hand.click(button(page, 'Upload a file').first()),
    ]);
    await chooser.setFiles({ mimeType: '', ...file });
}

async function takeRepaired(page, hand, name) {
    await page.locator('.outcome').filter({ hasText: 'closed' }).waitFor();
    await hand.click(button(page, name));
}

async function download(page, hand, context) {
    const [file] = await Promise.all([
        page.waitForEvent('download'),
        hand.click(button(page, 'Download STL')),
    ]);
    await waitForTold(page, /Exported/);
    context.saved = { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

// The saved file is a solid without a hole and without a face that looks the other way.
async function checkSolid({ daemon, saved, faces }) {
    assert.equal(saved.name, 'broken.stl');
    const answer = await fetch(`${daemon.url}/v1/meshes?format=stl`, {
        method: 'POST',
        headers: { 'Content-Type': 'application/octet-stream' },
        body: saved.bytes,
    });
    const { id, counts, closed } = await answer.json();
    assert.equal(answer.status, 201);
    assert.ok(closed, JSON.stringify(counts));
    assert.equal(counts.faces, faces);
    const { totals } = await get(daemon, `/${id}/check`);
    assert.ok(Object.values(totals).every((total) => total === 0), JSON.stringify(totals));
    const { items } = await get(daemon, '');
    assert.deepEqual(items.map(({ name }) => name).filter((name) => name === 'broken'), ['broken']);
}

// A ball with a hole is accepted by the server, and the page offers to repair it.
const repairHole = {
    name: 'repair and download an STL with a hole',
    most: 4,
    async prepare() {
        const triangles = ballOf();
        return { bytes: stlOf(triangles.slice(1)), faces: triangles.length };
    },
    async run(page, hand, context) {
        await upload(page, hand, { name: 'broken.stl', buffer: context.bytes });
        await hand.click(page.getByRole('button', { name: 'Repair' }));
        await takeRepaired(page, hand, 'Use repaired mesh');
        await download(page, hand, context);
    },
    check: checkSolid,
};

// A ball with a hole, a turned and a doubled triangle is refused by the server.
const repairRefused = {
    name: 'repair and download an STL that is refused',
    most: 3,
    async prepare() {
        const triangles = ballOf();
        const broken = [[...triangles[5]].reverse(), triangles[9], ...triangles.slice(1)];
        broken.splice(broken.indexOf(triangles[5]), 1);
        return { bytes: stlOf(broken), faces: triangles.length };
    },
    async run(page, hand, context) {
        await upload(page, hand, { name: 'broken.stl', buffer: context.bytes });
        await takeRepaired(page, hand, 'Import repaired mesh');
        await download(page, hand, context);
    },
    check: checkSolid,
};

// Holes of 4, 8, 6, 10 and 12 edges in a torus, so that the third-largest has 8.
const fillThird = {
    name: 'find and fill the third-largest hole',
    most: 3,
    async prepare(daemon) {
        const shape = { shape: 'torus', major_segments: 24, minor_segments: 12 };
        const { id: mesh } = await post(daemon, '', { name: 'holes', ...shape });
        const faces = [1, 40, 41, 42, 80, 81, 120, 121, 122, 123, 160, 161, 162, 163, 164];
        await post(daemon, `/${mesh}/edits`, { op: 'face_delete', faces });
        return { mesh };
    },
    async run(page, hand) {
        await hand.click(button(page, 'Check'));
        const loops = page.getByRole('list', { name: 'Boundary loops' });
        await hand.click(loops.getByRole('button').nth(2));
        await hand.click(loops.getByRole('button', { name: 'Fill', exact: false }).first());
        await page.locator('#lens-said').filter({ hasText: 'The hole is filled.' }).waitFor();
    },
    async check({ daemon, mesh }) {
        const { loops } = await get(daemon, `/${mesh}/boundaries`);
        assert.deepEqual(loops.map(({ length }) => length).sort((a, b) => a - b), [4, 6, 10, 12]);
        // The hole is not flat, so the first way to fill it is that with triangles, which leaves no defect.
        const { totals } = await get(daemon, `/${mesh}/check`);
        assert.equal(totals.nonplanar_face, 0);
    },
};

// The wall of a plate is as thick as the plate.
const measureWall = {
    name: 'measure a wall',
    most: 4,
    async prepare(daemon) {
        const { id: mesh } = await post(daemon, '', { name: 'plate', shape: 'cube' });
        const matrix = [4, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 1];
        await post(daemon, `/${mesh}/edits`, { op: 'transform', matrix });
        return { mesh };
    },
    async run(page, hand, { daemon, mesh, said }) {
        const { at, isSeen } = await projector(page, daemon, mesh);
        const faces = await getAll(daemon, mesh, 'faces');
        const broad = faces.filter(({ area }) => area > 4).find(isSeen);
        await hand.click(button(page, 'Measure').first());
        await hand.choose(page.getByLabel('What to measure'), { label: 'Wall thickness' });
        await hand.click(page.locator('#canvas'), { position: at(broad.vertices) });
        said.push(await page.locator('#measure-results strong').textContent());
    },
    async check({ daemon, mesh, said }) {
        const { bbox, revision } = await get(daemon, `/${mesh}`);
        assert.deepEqual(said, [`${bbox.max[2] - bbox.min[2]}`]);
        assert.equal(revision, 2);
    },
};

// Yesterday the mesh had one more face than now; the visitor comes a day after the edits.
const backToYesterday = {
    name: 'undo to yesterday\u2019s moment and compare',
    most: 3,
    later: DAY,
    async prepare(daemon) {
        const { id: mesh } = await post(daemon, '', { name: 'past', shape: 'grid', columns: 6, rows: 6 });
        const edit = (operation) => post(daemon, `/${mesh}/edits`, operation);
        await edit({ op: 'face_poke', face: 3 });
        const { counts } = await get(daemon, `/${mesh}`);
        await fetch(`${daemon.url}/v1/meshes/${mesh}/edits/2`, {
            method: 'PATCH',
            headers: { 'Content-Type': 'application/json' },
            body: JSON.stringify({ name: 'as agreed' }),
        });
        await edit({ op: 'face_delete', face: 20 });
        await edit({ op: 'face_poke', face: 30 });
        return { mesh, counts };
    },
    async run(page, hand, { mesh }) {
        const rows = page.getByRole('list', { name: 'History' }).getByRole('listitem');
        const agreed = rows.filter({ hasText: 'as agreed' });
        await agreed.getByText('yesterday').waitFor();
        await hand.click(agreed.getByRole('button', { name: 'as agreed' }));
        // Each of the two edits since is undone by a revision of its own.
        await waitForFrame(page, { mesh, revision: 6 });
        await hand.click(button(page, 'Look at revision 4'));
        await hand.click(page.getByRole('checkbox', { name: 'Compare with the present' }));
        await page.locator('#past-said').filter({ hasText: '3 faces gone, 1 face new, 1 face changed' }).waitFor();
    },
    async check({ daemon, mesh, counts }) {
        assert.deepEqual((await get(daemon, `/${mesh}`)).counts, counts);
    },
};

const teachSplit = {
    name: 'teach edge_split',
    most: 5,
    async prepare(daemon) {
        const { id: mesh } = await post(daemon, '', { name: 'grid', shape: 'grid', columns: 3, rows: 3 });
        return { mesh };
    },
    async run(page, hand, { daemon, mesh }) {
        const { at } = await projector(page, daemon, mesh);
        const edge = (await getAll(daemon, mesh, 'edges')).find(({ boundary }) => !boundary);
        await hand.click(page.locator('#pick-modes label').filter({ hasText: /^\s*Edge\s*$/ }));
        await hand.click(page.locator('#canvas'), { position: at(edge.vertices) });
        await waitForFrame(page, { selection: `edge:${edge.id}` });
        await hand.choose(page.getByLabel('Operation', { exact: true }), 'edge_split');
        await hand.click(button(page, 'Show step by step'));
        const lesson = page.getByRole('dialog', { name: /step by step/ });
        await lesson.waitFor();
        for (;;) {
            const text = await lesson.getByRole('heading', { level: 3 }).textContent();
            const [, step, count] = /^(\d+) of (\d+)/.exec(text);
            if (step === count) {
                break;
            }
            await hand.press('Enter');
        }
        await lesson.getByText('The Euler characteristic').waitFor();
    },
    async check({ daemon, mesh }) {
        assert.equal((await get(daemon, `/${mesh}`)).revision, 1);
        assert.deepEqual((await get(daemon, '')).items.map(({ id }) => id), [mesh]);
    },
};

export const TASKS = [repairHole, repairRefused, fillThird, measureWall, backToYesterday, teachSplit];

// Returns the length of the body of an answer as it is sent. fetch() would hide the coding.
async function receivedSize(url, coding) {
    const request = http.get(url, { headers: { 'Accept-Encoding': coding } });
    const [answer] = await once(request, 'response');
    assert.equal(answer.statusCode, 200, url);
    let size = 0;
    for await (const piece of answer) {
        size += piece.length;
    }
    return size;
}

// Returns how many bytes a browser receives that accepts `coding` and loads the files that an open page
// has loaded, from the address `origin` or else from where the page got them. Answers of the API do not
// count, because they depend on the meshes.
export async function compressedSize(page, coding = 'gzip', origin = undefined) {
    const urls = await page.evaluate(() => [
        location.href.replace(/#.*/, ''),
        ...performance.getEntriesByType('resource').map(({ name }) => name),
    ]);
    const files = [...new Set(urls)].filter((url) => !new URL(url).pathname.startsWith('/v1/'));
    assert.ok(files.length > 2, `${files}`); // the page, its script and its style
    const addresses = files.map((url) => new URL(new URL(url).pathname, origin ?? url));
    const sizes = await Promise.all(addresses.map((url) => receivedSize(url, coding)));
    return sizes.reduce((sum, size) => sum + size, 0);
}
