// Tests which parts of a texture are uploaded again after a change, without drawing anything.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { FloatType, RGBAFormat } from '../../web/node_modules/three/build/three.module.js';
import { ROW } from '../../web/src/geometry/geometry.js';
import { Rows } from '../../web/src/gl/rows.js';

function rows(count) {
    const made = new Rows(new Float32Array(4 * ROW * count), RGBAFormat, FloatType);
    const update = (...places) => made.update(made.image.data, Uint32Array.from(places));
    return { made, update, ranges: () => made.updateRanges.map((r) => [r.start / 4, r.count / 4]) };
}

test('what changed is sent in ranges, none of which leaves its row', () => {
    const { made, update, ranges } = rows(3);
    made.onUpdate();
    const { version } = made;
    assert.equal(update(), made);
    assert.equal(made.version, version);
    assert.equal(update(0, 1, 2, 9, ROW - 1, ROW, ROW + 1, 3 * ROW - 1), made);
    assert.deepEqual(ranges(), [[0, 3], [9, 1], [ROW - 1, 1], [ROW, 2], [3 * ROW - 1, 1]]);
    assert.ok(made.version > version);
});

test('what was never sent, or is lost, is sent whole', () => {
    const { made, update, ranges } = rows(1);
    update(5);
    assert.deepEqual(ranges(), []);
    made.onUpdate();
    update(5);
    assert.deepEqual(ranges(), [[5, 1]]);
    made.forget();
    assert.deepEqual(ranges(), []);
    update(6);
    assert.deepEqual(ranges(), []);
});

test('much is sent as a whole, and another array by another texture', () => {
    const { made, update, ranges } = rows(1);
    made.onUpdate();
    update(1);
    update(...Array.from({ length: ROW / 2 }, (_, i) => 2 * i));
    assert.deepEqual(ranges(), []);
    let isDisposed = false;
    made.addEventListener('dispose', () => {
        isDisposed = true;
    });
    const longer = made.update(new Float32Array(8 * ROW), Uint32Array.of(1));
    assert.notEqual(longer, made);
    assert.ok(isDisposed);
    assert.equal(longer.image.height, 2);
    assert.deepEqual(longer.updateRanges, []);
});

test('long ranges are sent up to a larger part, and none of what was never sent', () => {
    const { made, ranges } = rows(3);
    made.updateWithin([[0, 512]]);
    assert.deepEqual(ranges(), []);
    made.onUpdate();
    const { version } = made;
    made.updateWithin([]);
    assert.equal(made.version, version);
    made.updateWithin([[0, ROW], [ROW + 256, ROW + 512]]);
    assert.deepEqual(ranges(), [[0, ROW], [ROW + 256, 256]]);
    assert.ok(made.version > version);
    made.updateWithin([[0, ROW], [ROW, 2 * ROW]]);
    assert.deepEqual(ranges(), []);
});
