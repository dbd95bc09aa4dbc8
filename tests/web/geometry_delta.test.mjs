// Tests that the page's arrays, after it has applied changes to them, equal the complete arrays
// that a real daemon sends.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { findFaces, trianglesOfFace, unpack } from '../../web/src/geometry/geometry.js';
import { applyDelta } from '../../web/src/geometry/geometry_delta.js';
import { get, startDaemon } from './daemon.mjs';
import { countIssued, numbersFrom, randomEdit } from './random.mjs';

const EDITS = Number(process.env.EDITS ?? 1000);
const SEED = Number(process.env.SEED ?? Date.now() % 2 ** 32);

// Returns the arrays of an answer without unused space at their end, so that changes that add
// elements must enlarge the arrays.
function wholeOf(buffer) {
    const geometry = unpack(buffer);
    const { vertices, vertexCount, triangles, triangleCount } = geometry;
    geometry.vertices = vertices.slice(0, 4 * vertexCount);
    geometry.triangles = triangles.slice(0, 4 * triangleCount);
    return geometry;
}

async function fetchGeometry(url, query = '') {
    const answer = await fetch(`${url}/geometry${query}`);
    assert.equal(answer.status, 200);
    return answer.arrayBuffer();
}

async function update(url, geometry, tally) {
    const query = `?since=${geometry.revision}&layout=${geometry.layout}`;
    const buffer = await fetchGeometry(url, query);
    const changed = applyDelta(geometry, buffer, 64);
    tally[changed === null ? 'whole' : 'changes']++;
    tally.bytes += changed === null ? 0 : buffer.byteLength;
    if (changed !== null) {
        findFaces(geometry, changed.triangles);
    }
    return changed === null ? wholeOf(buffer) : geometry;
}

function bytesOf(array, count) {
    return Buffer.from(array.buffer, array.byteOffset, 16 * count);
}

function assertSame(kept, fresh) {
    for (const name of ['revision', 'layout', 'vertexCount', 'triangleCount']) {
        assert.equal(kept[name], fresh[name], name);
    }
    for (const [array, count] of [['vertices', 'vertexCount'], ['triangles', 'triangleCount']]) {
        assert.ok(bytesOf(kept[array], kept[count]).equals(bytesOf(fresh[array], fresh[count])));
        assert.ok(kept[array].subarray(4 * kept[count]).every((word) => word === 0));
    }
    for (let face = 0; face < fresh.firstOf.length; face++) {
        assert.deepEqual(trianglesOfFace(kept, face), trianglesOfFace(fresh, face));
    }
}

async function post(url, body) {
    const answer = await fetch(url, {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify(body),
    });
    const said = await answer.json();
    assert.ok(answer.ok || [409, 422].includes(answer.status), JSON.stringify(said));
    return answer.ok ? said : null;
}

test('after random edits the patched arrays equal fresh ones', async (t) => {
    console.log(`note: SEED=${SEED}`);
    const below = numbersFrom(SEED);
    const daemon = await startDaemon(t);
    const url = `${daemon.url}/v1/meshes/m`;
    const shape = { shape: 'torus', major_segments: 16, minor_segments: 12 };
    await fetch(url, {
        method: 'PUT',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify(shape),
    });
    const { counts } = await get(daemon, '/m');
    const issued = { vertices: counts.vertices, edges: counts.edges, faces: counts.faces };
    const tally = { changes: 0, whole: 0, bytes: 0 };
    let geometry = wholeOf(await fetchGeometry(url));
    for (let done = 0; done < EDITS; ) {
        const dice = below(100);
        let said;
        if (dice < 80) {
            const ops = Array.from({ length: dice < 70 ? 1 : 3 }, () => randomEdit(below, issued));
            said = await post(`${url}/edits`, ops.length === 1 ? ops[0] : { ops });
        } else {
            said = await post(`${url}/${dice < 92 ? 'undo' : 'redo'}`);
        }
        done += said === null ? 0 : 1;
        if (said !== null) {
            countIssued(issued, said);
        }
        if (below(3) === 0) {
            geometry = await update(url, geometry, tally);
        }
        if (below(50) === 0) {
            geometry = await update(url, geometry, tally);
            assertSame(geometry, wholeOf(await fetchGeometry(url)));
        }
    }
    geometry = await update(url, geometry, tally);
    assertSame(geometry, wholeOf(await fetchGeometry(url)));
    assert.ok(tally.changes > 5 * tally.whole, JSON.stringify(tally));
    const bytes = Math.round(tally.bytes / tally.changes);
    console.log(`note: ${tally.changes} changes of ${bytes} bytes, ${tally.whole} fetched whole`);
});

// --- without a daemon ---

// Builds an answer of GET .../geometry?since= from its changed array entries, each [index, a, b, c,
// d].
function answer(vertices, triangles, { base = 1, layout = 9, counts = [3, 2] } = {}) {
    const bytes = [vertices, triangles].map(
        (rows) => 16 * Math.ceil(rows.length / 4) + 16 * rows.length,
    );
    const buffer = new ArrayBuffer(96 + bytes[0] + bytes[1]);
    const view = new DataView(buffer);
    [...'HEDG'].forEach((letter, i) => view.setUint8(i, letter.charCodeAt(0)));
    view.setUint32(4, 2, true);
    view.setBigUint64(8, 2n, true);
    view.setBigUint64(16, BigInt(base), true);
    bytes.forEach((length, i) => view.setBigUint64(24 + 8 * i, BigInt(length), true));
    counts.forEach((count, i) => view.setUint32(40 + 4 * i, count, true));
    view.setBigUint64(80, BigInt(layout), true);
    let at = 96;
    [vertices, triangles].forEach((rows, part) => {
        view.setUint32(88 + 4 * part, rows.length, true);
        const data = at + 16 * Math.ceil(rows.length / 4);
        rows.forEach(([place, ...row], i) => {
            view.setUint32(at + 4 * i, place, true);
            const put = part === 0 ? 'setFloat32' : 'setUint32';
            row.forEach((value, k) => view[put](data + 16 * i + 4 * k, value, true));
        });
        at += bytes[part];
    });
    return buffer;
}

function small() {
    return {
        revision: 1,
        layout: 9,
        vertices: new Float32Array(12).fill(1),
        vertexCount: 3,
        triangles: new Uint32Array(8).fill(5),
        triangleCount: 2,
    };
}

test('rows go to their places, in the arrays there are', () => {
    const geometry = small();
    const { vertices, triangles } = geometry;
    const changed = applyDelta(geometry, answer([[1, 0.5, 0, 0, 2]], [[0, 0, 0, 0, 0]]));
    assert.deepEqual([...changed.vertices], [1]);
    assert.deepEqual([...changed.triangles], [0]);
    assert.equal(changed.grown, false);
    assert.equal(geometry.vertices, vertices);
    assert.deepEqual([...vertices], [1, 1, 1, 1, 0.5, 0, 0, 2, 1, 1, 1, 1]);
    assert.deepEqual([...triangles], [0, 0, 0, 0, 5, 5, 5, 5]);
    assert.equal(geometry.revision, 2);
});

test('arrays that are too short grow by whole rows, with zeros', () => {
    const geometry = small();
    const changed = applyDelta(geometry, answer([], [[4, 1, 2, 3, 4]], { counts: [3, 5] }), 4);
    assert.equal(changed.grown, true);
    assert.equal(geometry.triangles.length, 4 * 8);
    assert.deepEqual([...geometry.triangles.subarray(8, 20)], [0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4]);
    assert.deepEqual([geometry.vertexCount, geometry.triangleCount], [3, 5]);
    assert.equal(geometry.vertices.length, 12);
});

test('all rows are left to whoever makes the arrays, and other changes are refused', () => {
    const geometry = small();
    assert.equal(applyDelta(geometry, answer([], [], { base: 0 })), null);
    const row = [2, 1, 1, 1, 1];
    const wrong = [
        answer([row], [], { base: 2 }),
        answer([row], [], { layout: 8 }),
        answer([row], [row]),
        answer([row], [], { counts: [2, 2] }),
        answer([row], []).slice(0, -16),
        new Uint8Array([...new Uint8Array(answer([row], [])), ...new Uint8Array(16)]).buffer,
        new ArrayBuffer(96),
    ];
    for (const buffer of wrong) {
        assert.throws(() => applyDelta(geometry, buffer), RangeError);
    }
    assert.deepEqual(geometry, small());
});
