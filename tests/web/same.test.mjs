// Tests that after many edits by several clients a page has the same bytes in its arrays and in
// graphics memory as a page that has just been opened. The variables EDITS (300 if not set; `make
// proof` takes 1000) and SEED come from the environment.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { unpack } from '../../web/src/geometry/geometry.js';
import { waitForFrame } from './browser.mjs';
import { get, getGeometry, post, startDaemon } from './daemon.mjs';
import { chooseOperation, fillVector, isEdit } from './page.mjs';
import { countIssued, numbersFrom, randomEdit } from './random.mjs';
import { openPage } from './visit.mjs';

const EDITS = Number(process.env.EDITS ?? 300);
const SEED = Number(process.env.SEED ?? Date.now() % 2 ** 32);

// How many textures have the format of each array: its own and that of the materials; beside the
// vertices also that of the values by which the mesh is coloured.
const TEXTURES = { vertices: 3, triangles: 2 };

// Runs in the page: keeps a copy of all data that is uploaded to 32-bit textures, so that the
// copies equal the textures in graphics memory, and remembers the arrays from which the data came.
function keepTextures() {
    const { prototype } = WebGL2RenderingContext;
    const kept = new Map();
    const pixels = new Map();
    const hook = (name, act) => {
        const real = prototype[name];
        prototype[name] = function hooked(...args) {
            act.call(this, ...args);
            return real.apply(this, args);
        };
    };
    hook('pixelStorei', (name, value) => pixels.set(name, value));
    hook('texStorage2D', function allocate(target, levels, format, width, height) {
        if (format === this.RGBA32F || format === this.RGBA32UI) {
            const words = new Uint32Array(4 * width * height);
            const sources = new Set();
            kept.set(this.getParameter(this.TEXTURE_BINDING_2D), { format, width, words, sources });
        }
    });
    hook('texSubImage2D', function send(target, level, x, y, width, height, ...[, , data]) {
        const texture = kept.get(this.getParameter(this.TEXTURE_BINDING_2D));
        if (texture !== undefined) {
            const from = new Uint32Array(data.buffer, data.byteOffset, data.length);
            texture.sources.add(data.buffer);
            const length = pixels.get(this.UNPACK_ROW_LENGTH) || width;
            const left = pixels.get(this.UNPACK_SKIP_PIXELS) ?? 0;
            const top = pixels.get(this.UNPACK_SKIP_ROWS) ?? 0;
            for (let row = 0; row < height; row++) {
                const at = 4 * ((top + row) * length + left);
                const to = 4 * ((y + row) * texture.width + x);
                texture.words.set(from.subarray(at, at + 4 * width), to);
            }
        }
    });
    hook('deleteTexture', (texture) => kept.delete(texture));
    // The test recognizes the mesh's texture because it was uploaded directly from the
    // mesh's array.
    window.readTextures = ({ vertices, triangles }) => {
        const { RGBA32F, RGBA32UI } = WebGL2RenderingContext;
        const find = (wanted, { buffer }) => {
            const all = [...kept.values()].filter(({ format }) => format === wanted);
            const own = all.filter(({ sources }) => sources.size === 1 && sources.has(buffer));
            return { count: all.length, own };
        };
        return { vertices: find(RGBA32F, vertices), triangles: find(RGBA32UI, triangles) };
    };
}

// Returns the bytes of the page's arrays and of its textures, as text.
function readArrays(page) {
    return page.evaluate(() => {
        const text = (array, count) => {
            const bytes = new Uint8Array(array.buffer, array.byteOffset, 16 * count);
            let binary = '';
            for (let i = 0; i < bytes.length; i += 8192) {
                binary += String.fromCharCode(...bytes.subarray(i, i + 8192));
            }
            return btoa(binary);
        };
        const { geometry } = document.getElementById('canvas');
        const { revision, layout, vertexCount, triangleCount } = geometry;
        const textures = window.readTextures(geometry);
        const both = (name, count) => ({
            array: text(geometry[name], count),
            textures: textures[name].own.map(({ words }) => text(words, count)),
            textureCount: textures[name].count,
        });
        return {
            revision,
            layout,
            vertices: both('vertices', vertexCount),
            triangles: both('triangles', triangleCount),
        };
    });
}

async function checkSame(daemon, mesh, page) {
    const fresh = unpack(await getGeometry(daemon, mesh));
    await waitForFrame(page, { mesh, revision: fresh.revision });
    const kept = await readArrays(page);
    assert.deepEqual([kept.revision, kept.layout], [fresh.revision, fresh.layout]);
    for (const [name, count] of [['vertices', 'vertexCount'], ['triangles', 'triangleCount']]) {
        const wanted = Buffer.from(fresh[name].buffer, 0, 16 * fresh[count]).toString('base64');
        const { array, textures, textureCount } = kept[name];
        assert.ok(array === wanted, `${name} of the page at revision ${fresh.revision}`);
        assert.deepEqual([textures.length, textureCount], [1, TEXTURES[name]], `textures of ${name}`);
        assert.ok(textures[0] === wanted, `${name} of its texture at ${fresh.revision}`);
    }
}

// Does at random what a user of the page may do: undo, redo, or an edit by a form. Returns false if
// the server refused it.
async function actOnPage(page, daemon, mesh, below, issued) {
    const { revision, undo, redo } = await get(daemon, `/${mesh}/edits?limit=1`);
    await waitForFrame(page, { mesh, revision });
    const dice = below(3);
    if (dice === 0 && undo > 0) {
        await page.getByRole('button', { name: 'Undo', exact: true }).click();
    } else if (dice === 1 && redo > 0) {
        await page.getByRole('button', { name: 'Redo', exact: true }).click();
    } else {
        const answer = page.waitForResponse(isEdit);
        await page.locator('#param-vertex').fill(`${below(issued.vertices)}`);
        await fillVector(page, 'by', [0, 0, 0.01]);
        await page.getByRole('button', { name: 'Apply' }).click();
        if (!(await answer).ok()) {
            return false;
        }
    }
    await waitForFrame(page, { mesh, revision: revision + 1 });
    return true;
}

async function actBeside(daemon, mesh, below, issued) {
    const dice = below(100);
    const many = Array.from({ length: dice < 75 ? 1 : 3 }, () => randomEdit(below, issued));
    const [path, body] =
        dice < 80 ? ['edits', { ops: many }] : [dice < 92 ? 'undo' : 'redo', {}];
    try {
        countIssued(issued, await post(daemon, `/${mesh}/${path}`, body));
        return true;
    } catch (error) {
        assert.match(error.message, / (409|422) /);
        return false;
    }
}

test('after random edits the arrays equal fresh ones', async (t) => {
    console.log(`note: SEED=${SEED}`);
    const below = numbersFrom(SEED);
    const daemon = await startDaemon(t);
    const shape = { shape: 'torus', major_segments: 60, minor_segments: 50 };
    const { id: mesh, counts } = await post(daemon, '', shape);
    const issued = { vertices: counts.vertices, edges: counts.edges, faces: counts.faces };
    const page = await openPage(t, daemon, {
        allowed: [/status of 4(09|10|22)/],
        init: keepTextures,
    });
    await waitForFrame(page, { mesh, revision: 1 });
    await chooseOperation(page, 'vertex_move');
    const whole = [];
    page.on('request', (request) => {
        if (request.url().endsWith('/geometry')) {
            whole.push(request.url());
        }
    });
    let own = 0;
    for (let done = 0; done < EDITS; ) {
        const isOwn = below(20) === 0;
        const act = isOwn
            ? actOnPage(page, daemon, mesh, below, issued)
            : actBeside(daemon, mesh, below, issued);
        const isDone = await act;
        done += isDone ? 1 : 0;
        own += isDone && isOwn ? 1 : 0;
        if (isDone && done % 100 === 0) {
            await checkSame(daemon, mesh, page);
        }
    }
    await checkSame(daemon, mesh, page);
    assert.ok(own > EDITS / 100, `${own} edits of the page's own`);
    assert.deepEqual(whole, []);
    console.log(`note: ${EDITS} edits, ${own} of them by the page`);
});
