// lengths.js - how measured lengths, areas and angles are written: lengths and areas in the unit that
// the user has chosen.

import { formatMeasure } from './dom.js';
import { formatSize } from './units.js';

export function formatLength(length) {
    return formatSize(length, 1);
}

export function formatArea(area) {
    return formatSize(area, 2);
}

// Writes an angle, which is given in radians, in degrees with at most `digits` significant digits.
export function formatAngle(angle, digits = 6) {
    return `${formatMeasure((angle * 180) / Math.PI, digits)}\u00b0`;
}
