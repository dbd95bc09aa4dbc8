// png.mjs - reads the pixels of a screenshot, a PNG as Chromium writes it: 8 bits, RGB or RGBA, not
// interlaced. The filters are described in the PNG specification (W3C), 9.2.

import assert from 'node:assert/strict';
import { inflateSync } from 'node:zlib';

const CHANNELS = { 2: 3, 6: 4 }; // numbers of channels by PNG colour type

// Returns {width, height, channels, pixels}, with the rows of pixels from top to bottom.
export function readPng(file) {
    const [width, height] = [16, 20].map((at) => file.readUInt32BE(at));
    const channels = CHANNELS[file[25]];
    assert.ok(file[24] === 8 && channels !== undefined && file[28] === 0);
    const raw = inflateSync(Buffer.concat(chunksOf(file, 'IDAT')));
    const stride = channels * width;
    const pixels = Buffer.alloc(stride * height);
    for (let y = 0; y < height; y++) {
        const filter = raw[y * (stride + 1)];
        const row = raw.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1));
        undo(filter, row, pixels, y * stride, stride, channels);
    }
    return { width, height, channels, pixels };
}

function chunksOf(file, wanted) {
    const found = [];
    for (let at = 8; at < file.length; at += 12 + file.readUInt32BE(at)) {
        if (file.toString('latin1', at + 4, at + 8) === wanted) {
            found.push(file.subarray(at + 8, at + 8 + file.readUInt32BE(at)));
        }
    }
    return found;
}

// Undoes the PNG filter of a row and writes the row's bytes into `pixels`, from index `at` on. The
// pixels above must have been written before.
function undo(filter, row, pixels, at, stride, channels) {
    const guess = FILTERS[filter];
    for (let i = 0; i < stride; i++) {
        const left = i < channels ? 0 : pixels[at + i - channels];
        const above = at === 0 ? 0 : pixels[at + i - stride];
        const corner = at === 0 || i < channels ? 0 : pixels[at + i - stride - channels];
        pixels[at + i] = row[i] + guess(left, above, corner);
    }
}

const FILTERS = [
    () => 0,
    (left) => left,
    (left, above) => above,
    (left, above) => (left + above) >> 1,
    (left, above, corner) => {
        const a = Math.abs(above - corner);
        const b = Math.abs(left - corner);
        const c = Math.abs(left + above - 2 * corner);
        return a <= b && a <= c ? left : b <= c ? above : corner;
    },
];
