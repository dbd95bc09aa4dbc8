// lengths.js - how lengths, areas and angles are written. A mesh has no unit of its own, so its lengths
// are plain numbers.

import { formatMeasure } from './dom.js';

const DIGITS = 6;

export function formatLength(length) {
    return formatMeasure(length, DIGITS);
}

export function formatArea(area) {
    return formatMeasure(area, DIGITS);
}

// Writes an angle, which is given in radians, in degrees.
export function formatAngle(angle) {
    return `${formatMeasure((angle * 180) / Math.PI, DIGITS)}\u00b0`;
}
