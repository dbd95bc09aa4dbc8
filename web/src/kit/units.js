// units.js - the unit of lengths. A mesh has none: the user says which one its coordinates mean, and
// the page writes it behind lengths, areas and volumes. Nothing is converted.

import { formatMeasure } from './dom.js';

// The units that the user may choose; '' is none.
export const UNITS = ['', 'mm', 'cm', 'm', 'in'];

let unit = '';
const listeners = [];

export function setUnit(name) {
    if (name !== unit) {
        unit = name;
        listeners.forEach((act) => act());
    }
}

// Calls a function each time another unit was chosen.
export function onUnit(act) {
    listeners.push(act);
}

// Returns the unit of lengths, areas or volumes, for `power` 1, 2 or 3, as it is written behind a
// number; '' if there is none.
export function unitText(power = 1) {
    return unit === '' ? '' : `\u00a0${unit}${['', '', '\u00b2', '\u00b3'][power]}`;
}

// Formats a length (`power` 1), an area (2) or a volume (3) with its unit.
export function formatSize(value, power = 1, digits = 6) {
    return formatMeasure(value, digits) + (value === null ? '' : unitText(power));
}
