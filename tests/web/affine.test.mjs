// Tests of the parser for numbers that people type, and of the matrix that is made from scaling,
// rotation and translation.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { compose, textOf } from '../../web/src/kit/affine.js';
import { numbersOf, toggleWord } from '../../web/src/kit/numbers.js';

const STILL = { scale: [1, 1, 1], rotate: [0, 0, 0], translate: [0, 0, 0], about: [0, 0, 0] };

function put(matrix, point) {
    return [0, 4, 8].map(
        (row) =>
            point.reduce((sum, value, i) => sum + matrix[row + i] * value, 0) + matrix[row + 3],
    );
}

const mapped = (steps, point) => put(compose({ ...STILL, ...steps }), point);

test('steps that do nothing are the identity', () => {
    assert.deepEqual(compose(STILL), [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    assert.equal(textOf(compose(STILL)), '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1');
});

test('quarter turns are exact, and counter-clockwise seen from the tip of the axis', () => {
    assert.deepEqual(mapped({ rotate: [0, 0, 90] }, [1, 2, 3]), [-2, 1, 3]);
    assert.deepEqual(mapped({ rotate: [90, 0, 0] }, [1, 2, 3]), [1, -3, 2]);
    assert.deepEqual(mapped({ rotate: [0, -270, 0] }, [1, 2, 3]), [3, 2, -1]);
    const [x, y] = mapped({ rotate: [0, 0, 30] }, [1, 0, 0]);
    assert.ok(Math.hypot(x - Math.sqrt(3) / 2, y - 0.5) < 1e-15);
});

test('a mesh is scaled, then turned around x, y and z, then moved', () => {
    const steps = { scale: [2, 3, 4], rotate: [90, 0, 90], translate: [10, 20, 30] };
    // The point (1, 1, 1) is scaled to (2, 3, 4), rotated to (2, -4, 3) and (4, 2, 3), and then
    // moved.
    assert.deepEqual(mapped(steps, [1, 1, 1]), [14, 22, 33]);
});

test('the point that it is about stays, but for what moves all', () => {
    const steps = { scale: [2, 2, 2], rotate: [0, 90, 0], about: [1, 2, 3] };
    assert.deepEqual(mapped(steps, [1, 2, 3]), [1, 2, 3]);
    assert.deepEqual(mapped(steps, [2, 2, 3]), [1, 2, 1]);
    assert.deepEqual(mapped({ ...steps, translate: [0, 0, 5] }, [1, 2, 3]), [1, 2, 8]);
});

test('numbers are read between blanks, commas and brackets', () => {
    assert.deepEqual(numbersOf(' 1, -2.5;\t.5e1 ', 'p'), [1, -2.5, 5]);
    assert.deepEqual(numbersOf('[[1,2,3],\n(4 5 6)]', 'p'), [1, 2, 3, 4, 5, 6]);
    for (const word of ['0x10', 'Infinity', 'NaN', '1e999', '--1', '1_0']) {
        assert.throws(() => numbersOf(`1 ${word}`, 'p'), (error) => {
            assert.match(error.detail, /^p: .* is not a number\.$/);
            return error.pointer === '/ops/0/p';
        });
    }
});

test('a word comes into a list, or goes', () => {
    assert.equal(toggleWord('4 2', 7), '4 2 7');
    assert.equal(toggleWord('4, 2; 7', 2), '4 7');
    assert.equal(toggleWord('', 0), '0');
});
